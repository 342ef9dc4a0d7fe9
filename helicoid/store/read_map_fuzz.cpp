// Whatever bytes a map.gpkg holds, it is refused with a message or is a map. An input that begins like an SQLite file
// is read as it is; any other is a list of changes to a small map's file: three bytes of place, one of value each.
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "helicoid/store/map_file.hpp"
#include "tests/synthetic_room.hpp"

namespace {

std::string temporary_path() {
  static const std::string path =
      std::filesystem::temp_directory_path() / ("helicoid_fuzz_" + std::to_string(getpid()) + ".gpkg");
  return path;
}

std::string small_map_bytes() {
  if (!helicoid::write_map(helicoid::synthetic::random_map(1, 4, 8, 5), temporary_path())) std::abort();
  std::ifstream file(temporary_path(), std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string bytes_to_read(const std::string& input) {
  static const std::string small_map = small_map_bytes();
  if (input.starts_with("SQLite format 3")) return input;
  std::string bytes = small_map;
  for (std::size_t i = 0; i + 4 <= input.size(); i += 4) {
    const auto part = [&](std::size_t k) { return static_cast<std::size_t>(static_cast<unsigned char>(input[i + k])); };
    bytes[(part(0) + 256 * part(1) + 65536 * part(2)) % bytes.size()] = input[i + 3];
  }
  return bytes;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace helicoid;
  const std::string bytes = bytes_to_read(std::string(reinterpret_cast<const char*>(data), size));
  {
    std::ofstream file(temporary_path(), std::ios::binary | std::ios::trunc);
    file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  }
  const Result<Map> map = read_map(temporary_path());
  std::filesystem::remove(temporary_path());
  if (!map && map.error().message.empty()) std::abort();
  // The file without a change must be read: else every other input would be refused unseen.
  if (size == 0 && !map) std::abort();
  return 0;
}
