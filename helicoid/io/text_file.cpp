#include "helicoid/io/text_file.hpp"

#include <fcntl.h>
#include <libdeflate.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>

namespace helicoid {

namespace {

/// An archive that claims to hold more is inflated piece by piece instead of all at once.
constexpr std::size_t kLargestGuess = std::size_t{1} << 30U;

/// Room for that many bytes that are all about to be written: the pages are asked for at once, which costs a third of
/// what a fault a page does. Where the system knows no such request the faults come one by one.
void make_room(std::string& bytes, std::size_t size) {
  bytes.clear();
  bytes.reserve(size);
#ifdef MADV_POPULATE_WRITE
  const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  const std::size_t before = (page - reinterpret_cast<std::uintptr_t>(bytes.data()) % page) % page;
  // A request that fails costs nothing but time.
  if (size > before + page) madvise(bytes.data() + before, (size - before) / page * page, MADV_POPULATE_WRITE);
#endif
  bytes.resize(size);
}

struct Descriptor {
  int value = -1;
  ~Descriptor() {
    if (value > STDIN_FILENO) close(value);
  }
};

Result<std::string> read_bytes(const std::string& path) {
  const Descriptor file{path == "-" ? STDIN_FILENO : open(path.c_str(), O_RDONLY | O_CLOEXEC)};
  if (file.value < 0) return fail("{}: {}; check the name and the permissions", path, std::strerror(errno));
  struct stat status {};
  if (fstat(file.value, &status) == 0 && S_ISDIR(status.st_mode)) {
    return fail("{}: is a directory; name a file in it", path);
  }
  std::string bytes;
  const bool sized = S_ISREG(status.st_mode);
  std::size_t used = 0;
  make_room(bytes, sized ? static_cast<std::size_t>(status.st_size) + 1 : std::size_t{1} << 20U);
  while (true) {
    if (used == bytes.size()) bytes.resize(2 * bytes.size());
    const ssize_t got = read(file.value, bytes.data() + used, bytes.size() - used);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return fail("{}: cannot be read: {}", path, std::strerror(errno));
    if (got == 0) break;
    used += static_cast<std::size_t>(got);
  }
  bytes.resize(used);
  return bytes;
}

bool is_gzip(const std::string& bytes) {
  return bytes.size() > 2 && bytes[0] == '\x1f' && bytes[1] == '\x8b';
}

/// All at once, if the archive is one whole member of the size that it states.
bool inflate_whole(const std::string& bytes, std::string& text) {
  if (bytes.size() < 18) return false;
  std::uint32_t stated = 0;
  std::memcpy(&stated, bytes.data() + bytes.size() - 4, 4);
  // Deflate cannot do better than about 1 : 1032.
  if (stated > kLargestGuess || stated / 1100 > bytes.size()) return false;
  const std::unique_ptr<libdeflate_decompressor, decltype(&libdeflate_free_decompressor)> decompressor(
      libdeflate_alloc_decompressor(), libdeflate_free_decompressor);
  make_room(text, stated);
  std::size_t consumed = 0;
  std::size_t produced = 0;
  const auto status = libdeflate_gzip_decompress_ex(decompressor.get(), bytes.data(), bytes.size(), text.data(),
                                                    text.size(), &consumed, &produced);
  return status == LIBDEFLATE_SUCCESS && consumed == bytes.size() && produced == text.size();
}

/// Piece by piece: several members, huge files, and what is left of damaged ones. Returns a warning, or nothing.
std::string inflate_pieces(const std::string& bytes, std::string& text) {
  text.clear();
  z_stream stream{};
  if (inflateInit2(&stream, 15 + 16) != Z_OK) return "zlib could not start";
  std::string warning;
  // zlib counts in 32 bits; the input is handed over in pieces too.
  std::size_t given = 0;
  std::string piece(std::size_t{1} << 18U, '\0');
  while (true) {
    if (stream.avail_in == 0) {
      const std::size_t next = std::min(bytes.size() - given, std::size_t{1} << 24U);
      // zlib's interface is not const-correct; it does not write to its input.
      stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data() + given));
      stream.avail_in = static_cast<uInt>(next);
      given += next;
    }
    stream.next_out = reinterpret_cast<Bytef*>(piece.data());
    stream.avail_out = static_cast<uInt>(piece.size());
    const int status = inflate(&stream, Z_NO_FLUSH);
    text.append(piece.data(), piece.size() - stream.avail_out);
    if (status == Z_STREAM_END) {
      if (stream.avail_in == 0 && given == bytes.size()) break;
      if (inflateReset(&stream) != Z_OK) break;
    } else if (status != Z_OK) {
      warning = status == Z_BUF_ERROR ? "the archive is cut off" : "the archive is damaged";
      break;
    }
  }
  inflateEnd(&stream);
  return warning;
}

}  // namespace

TextFile text_of_bytes(std::string bytes, const std::string& name) {
  TextFile file{name, {}, {}};
  if (!is_gzip(bytes)) {
    file.text = std::move(bytes);
  } else if (!inflate_whole(bytes, file.text)) {
    file.warning = inflate_pieces(bytes, file.text);
    if (!file.warning.empty()) {
      file.warning = fmt::format("{}: {} after {} bytes of text; what was there is used", file.name, file.warning,
                                 file.text.size());
    }
  }
  return file;
}

Result<TextFile> read_text_file(const std::string& path) {
  Result<std::string> bytes = read_bytes(path);
  if (!bytes) return tl::unexpected(bytes.error());
  return text_of_bytes(std::move(*bytes), path == "-" ? "stdin" : path);
}

bool looks_binary(const std::string& text) {
  return std::memchr(text.data(), 0, std::min<std::size_t>(text.size(), 1000)) != nullptr;
}

}  // namespace helicoid
