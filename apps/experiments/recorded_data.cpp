#include "apps/experiments/recorded_data.hpp"

#include <fmt/format.h>

#include <filesystem>

namespace helicoid {

std::string missing_data(const ExperimentOptions& options, const std::string& path) {
  std::error_code error;
  if (!options.data.empty() && std::filesystem::exists(options.data + "/" + path, error)) return "";
  return fmt::format("the recorded data {} is not there; --data names the folder that holds it", path);
}

}  // namespace helicoid
