// The folder that a verb writes into.
#pragma once

#include <filesystem>
#include <string>

#include "helicoid/base/result.hpp"

namespace helicoid {

/// Stands for a folder from before the work, when it is looked at, to after it, when the results go in. If the work
/// comes to nothing, the folder is as it was.
class OutputFolder {
 public:
  /// Makes the folder if it is missing. Errors: it is a file, cannot be made or written, or holds something that
  /// Helicoid did not make (it has no `mark` file) without `force`.
  [[nodiscard]] static Result<OutputFolder> open(const std::string& folder, const std::string& mark, bool force);
  OutputFolder(OutputFolder&& other) noexcept;
  OutputFolder& operator=(OutputFolder&&) = delete;
  /// Takes away a folder that was made and stayed empty.
  ~OutputFolder();

  /// Clears what an earlier run may have left and this one may not write: the new must not stand among the old.
  void clear_old_results() const;

 private:
  OutputFolder(std::filesystem::path path, bool made, bool ours) : path_(std::move(path)), made_(made), ours_(ours) {}

  std::filesystem::path path_;
  bool made_ = false;  ///< it was not there before
  bool ours_ = false;  ///< it holds an earlier run's results
};

}  // namespace helicoid
