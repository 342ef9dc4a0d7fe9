#include "helicoid/base/whole_file.hpp"

#include <filesystem>
#include <fstream>

namespace helicoid {

Result<void> write_whole_file(const std::string& path, std::string_view bytes) {
  const std::string beside = path + ".part";
  std::error_code error;
  {
    std::ofstream file(beside, std::ios::binary | std::ios::trunc);
    if (!file) return fail("{}: cannot be created; does its folder exist, and may you write there?", path);
    file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    file.flush();
    if (!file) {
      file.close();
      std::filesystem::remove(beside, error);
      return fail("{}: cannot be written; is the disc full?", path);
    }
  }
  std::filesystem::rename(beside, path, error);
  if (!error) return {};
  const std::string reason = error.message();
  std::filesystem::remove(beside, error);
  return fail("{}: cannot be replaced: {}", path, reason);
}

}  // namespace helicoid
