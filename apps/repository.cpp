#include "apps/repository.hpp"

#include <filesystem>

namespace helicoid {

namespace fs = std::filesystem;

std::string find_repository() {
  std::error_code error;
  for (fs::path at = fs::current_path(error); !at.empty(); at = at.parent_path()) {
    if (fs::exists(at / "worlds" / "office.svg", error) && fs::exists(at / "helicoid" / "mapping", error)) {
      return at.string();
    }
    if (at == at.root_path()) break;
  }
  return {};
}

std::string find_recorded_data() {
  const std::string repository = find_repository();
  if (repository.empty()) return {};
  std::error_code error;
  const fs::path data = fs::path(repository).parent_path() / "shared" / "data";
  return fs::is_directory(data, error) ? data.string() : std::string();
}

}  // namespace helicoid
