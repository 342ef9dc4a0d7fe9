// Whatever a TUM file holds, each line becomes a pose or is counted; poses survive being written.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "helicoid/io/trajectory.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace helicoid;
  const TumFile file = parse_tum(std::string(reinterpret_cast<const char*>(data), size), "fuzz");
  const TumFile again = parse_tum(to_tum(file.poses), "again");
  if (again.poses.size() != file.poses.size()) std::abort();
  return 0;
}
