#include "apps/output_folder.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <vector>

namespace helicoid {

namespace fs = std::filesystem;

namespace {

constexpr std::array kFolders = {"islands", "sheets", "trajectories", "plots", "truth"};
constexpr std::array kFiles = {"map.gpkg",   "map.png",          "map.pgm",     "map.yaml",      "map.svg",
                               "sketch.svg", "topology.geojson", "ledger.json", "decisions.json"};
constexpr std::array kKinds = {".tum", ".png", ".pgm", ".yaml", ".svg", ".geojson"};

/// Removes the files of our kinds below a folder, and the folders that are empty then.
void remove_ours_below(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> folders{folder};
  for (const auto& entry : fs::recursive_directory_iterator(folder, error)) {
    if (entry.is_directory(error)) folders.push_back(entry.path());
    const bool ours = std::find(kKinds.begin(), kKinds.end(), entry.path().extension()) != kKinds.end();
    if (entry.is_regular_file(error) && ours) fs::remove(entry.path(), error);
  }
  // Inner folders come after those that hold them.
  for (auto it = folders.rbegin(); it != folders.rend(); ++it) fs::remove(*it, error);
}

}  // namespace

Result<OutputFolder> OutputFolder::open(const std::string& folder, const std::string& mark, bool force) {
  std::error_code error;
  const fs::path path(folder);
  const bool exists = fs::exists(path, error);
  if (exists && !fs::is_directory(path, error)) return fail("{}: is a file; name a folder for --out", folder);
  const bool ours = fs::exists(path / mark, error);
  if (exists && !ours && !force && !fs::is_empty(path, error)) {
    return fail("{}: is not empty and was not made by this verb; name another folder or say --force", folder);
  }
  error.clear();
  fs::create_directories(path, error);
  if (error) return fail("{}: cannot be made: {}", folder, error.message());
  if (access(path.c_str(), W_OK) != 0) return fail("{}: cannot be written; may you write there?", folder);
  return OutputFolder(path, !exists, ours);
}

OutputFolder::OutputFolder(OutputFolder&& other) noexcept
    : path_(std::move(other.path_)), made_(std::exchange(other.made_, false)), ours_(other.ours_) {}

OutputFolder::~OutputFolder() {
  std::error_code error;
  // Removing fails, as it should, if anything is in it.
  if (made_) fs::remove(path_, error);
}

void OutputFolder::clear_old_results() const {
  if (!ours_) return;
  std::error_code error;
  for (const char* name : kFolders) remove_ours_below(path_ / name);
  for (const char* name : kFiles) fs::remove(path_ / name, error);
}

}  // namespace helicoid
