#include "helicoid/simulation/grey_image.hpp"

#include <png.h>

#include <algorithm>
#include <cstring>
#include <sstream>

namespace helicoid {

namespace {

constexpr int kLargestSide = 20000;

struct PgmHeader {
  bool in_words = false;  ///< P2; else P5
  int width = 0, height = 0;
  int levels = 255;  ///< the value of white
};

Result<PgmHeader> read_pgm_header(std::istream& stream, const std::string& path) {
  std::string magic;
  stream >> magic;
  int values[3] = {};
  for (int& value : values) {
    stream >> std::ws;
    while (stream.peek() == '#') {
      std::string comment;
      std::getline(stream, comment);
      stream >> std::ws;
    }
    if (!(stream >> value)) return fail("{}: is no PGM: its header is cut off", path);
  }
  stream.get();
  const PgmHeader header{magic == "P2", values[0], values[1], values[2]};
  if ((magic != "P2" && magic != "P5") || header.width < 1 || header.height < 1 || header.width > kLargestSide ||
      header.height > kLargestSide || header.levels < 1 || header.levels > 65535) {
    return fail("{}: must be a PGM (P2 or P5) with sides up to {} pixels", path, kLargestSide);
  }
  return header;
}

Result<GreyImage> read_pgm(const std::string& bytes, const std::string& path) {
  std::istringstream stream(bytes);
  const Result<PgmHeader> header = read_pgm_header(stream, path);
  if (!header) return tl::unexpected(header.error());
  GreyImage image{header->width, header->height, {}};
  const auto begin = static_cast<std::size_t>(std::max<std::streamoff>(0, stream.tellg()));
  const auto count = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  // A value takes a byte, two where there are more levels than a byte holds, or a digit and a space.
  const std::size_t bytes_each = header->in_words || header->levels > 255 ? 2 : 1;
  if (begin > bytes.size() || (bytes.size() - begin + (header->in_words ? 1 : 0)) / bytes_each < count) {
    return fail("{}: is cut off", path);
  }
  image.pixels.resize(count);
  const auto byte = [&](std::size_t i) { return static_cast<int>(static_cast<std::uint8_t>(bytes[begin + i])); };
  for (std::size_t i = 0; i < count; ++i) {
    int value = 0;
    if (header->in_words) {
      if (!(stream >> value)) return fail("{}: is cut off", path);
    } else {
      value = bytes_each == 1 ? byte(i) : 256 * byte(2 * i) + byte(2 * i + 1);
    }
    image.pixels[i] = static_cast<std::uint8_t>(255 * std::clamp(value, 0, header->levels) / header->levels);
  }
  return image;
}

Result<GreyImage> read_png(const std::string& bytes, const std::string& path) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_memory(&png, bytes.data(), bytes.size()) == 0) return fail("{}: {}", path, png.message);
  png.format = PNG_FORMAT_GRAY;
  GreyImage image{static_cast<int>(png.width), static_cast<int>(png.height), {}};
  const auto count = static_cast<std::size_t>(png.width) * png.height;
  // Deflate cannot do better than about 1 : 1032, nor a pixel with less than a bit: what claims more is damaged.
  if (png.width > kLargestSide || png.height > kLargestSide || count / 9000 > bytes.size()) {
    png_image_free(&png);
    return fail("{}: is damaged, or larger than {} pixels a side", path, kLargestSide);
  }
  image.pixels.resize(count);
  const png_color behind{kUnknownGrey, kUnknownGrey, kUnknownGrey};
  if (png_image_finish_read(&png, &behind, image.pixels.data(), 0, nullptr) == 0)
    return fail("{}: {}", path, png.message);
  return image;
}

}  // namespace

Result<GreyImage> read_grey_image(const std::string& bytes, const std::string& name) {
  const bool png = bytes.size() > 4 && std::memcmp(bytes.data() + 1, "PNG", 3) == 0;
  return png ? read_png(bytes, name) : read_pgm(bytes, name);
}

}  // namespace helicoid
