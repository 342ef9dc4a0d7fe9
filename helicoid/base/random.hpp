// Seeded random numbers that are the same on every machine: the standard library's distributions are not.
#pragma once

#include <array>
#include <cstdint>

namespace helicoid {

/// xoshiro256++ (Blackman and Vigna 2019), seeded through splitmix64. Same seed, same numbers, everywhere.
class Random {
 public:
  explicit Random(std::uint64_t seed);

  /// 64 uniform bits.
  [[nodiscard]] std::uint64_t bits();
  /// Uniform in [0, 1).
  [[nodiscard]] double uniform();
  /// Uniform in [low, high).
  [[nodiscard]] double uniform(double low, double high);
  /// Uniform in {0, ..., count - 1}; count > 0.
  [[nodiscard]] std::uint64_t below(std::uint64_t count);
  /// Standard normal (Marsaglia's polar method).
  [[nodiscard]] double normal();
  /// True with this probability.
  [[nodiscard]] bool chance(double probability);
  /// An independent generator for a part of the work, so that parts do not disturb each other's numbers.
  [[nodiscard]] Random split();

 private:
  std::array<std::uint64_t, 4> state_{};
  double spare_ = 0;
  bool has_spare_ = false;
};

}  // namespace helicoid
