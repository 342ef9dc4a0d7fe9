#include "helicoid/eval/stamp_lookup.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace helicoid {

StampLookup::StampLookup(std::vector<double> stamps) : stamps_(std::move(stamps)), order_(stamps_.size()) {
  std::iota(order_.begin(), order_.end(), std::size_t{0});
  std::stable_sort(order_.begin(), order_.end(), [&](std::size_t a, std::size_t b) { return stamps_[a] < stamps_[b]; });
}

std::optional<std::size_t> StampLookup::nearest(double stamp, double tolerance) const {
  const auto at =
      std::lower_bound(order_.begin(), order_.end(), stamp, [&](std::size_t i, double t) { return stamps_[i] < t; });
  std::optional<std::size_t> found;
  double best = tolerance;
  if (at != order_.end() && std::abs(stamps_[*at] - stamp) <= best) {
    best = std::abs(stamps_[*at] - stamp);
    found = *at;
  }
  if (at != order_.begin() && std::abs(stamps_[*(at - 1)] - stamp) < best) found = *(at - 1);
  return found;
}

}  // namespace helicoid
