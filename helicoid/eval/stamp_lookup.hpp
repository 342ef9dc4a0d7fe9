// Finds what was taken at a stamp.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace helicoid {

class StampLookup {
 public:
  /// Stamps in any order, seconds.
  explicit StampLookup(std::vector<double> stamps);
  /// The place of the stamp nearest to this one, if it is within the tolerance (seconds).
  [[nodiscard]] std::optional<std::size_t> nearest(double stamp, double tolerance) const;

 private:
  std::vector<double> stamps_;
  std::vector<std::size_t> order_;  ///< places in order of time
};

}  // namespace helicoid
