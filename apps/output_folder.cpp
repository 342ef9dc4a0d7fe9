#include "apps/output_folder.hpp"

#include <array>
#include <filesystem>

namespace helicoid {

namespace fs = std::filesystem;

namespace {

/// What earlier runs may have left; a new run must not stand among old sheets and islands.
constexpr std::array kOurs = {"islands", "sheets", "trajectories", "truth"};

}  // namespace

Result<void> prepare_output_folder(const std::string& folder, const std::string& mark, bool force) {
  std::error_code error;
  const fs::path path(folder);
  if (fs::exists(path, error) && !fs::is_directory(path, error)) {
    return fail("{}: is a file; name a folder for --out", folder);
  }
  const bool holds_something = fs::exists(path, error) && !fs::is_empty(path, error);
  if (holds_something && !fs::exists(path / mark, error) && !force) {
    return fail("{}: is not empty and was not made by this verb; name another folder or say --force", folder);
  }
  if (holds_something) {
    for (const char* name : kOurs) fs::remove_all(path / name, error);
  }
  fs::create_directories(path, error);
  if (error) return fail("{}: cannot be made: {}", folder, error.message());
  return {};
}

}  // namespace helicoid
