// Which floor of its plane an island has seen, roughly: for what two islands would see twice.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "helicoid/manifold/map.hpp"

namespace helicoid {

constexpr double kSeenSquare = 0.40;  ///< the side of a square, metres

/// A square of an island's plane; its middle is ((column + 0.5) kSeenSquare, (row + 0.5) kSeenSquare).
struct FloorSquare {
  std::int32_t row = 0;
  std::int32_t column = 0;
  friend auto operator<=>(const FloorSquare&, const FloorSquare&) = default;
};
[[nodiscard]] FloorSquare square_at(const Vector2d& p_plane);
[[nodiscard]] Vector2d middle_of(const FloorSquare& square);

/// The squares whose middles some patch of the island has seen free.
class KnownSquares {
 public:
  KnownSquares(const Map& map, IslandId island);

  [[nodiscard]] bool has(const FloorSquare& square) const;
  [[nodiscard]] const std::vector<FloorSquare>& squares() const { return squares_; }  ///< ascending

 private:
  FloorSquare low_;
  std::int32_t width_ = 0, height_ = 0;
  std::vector<std::uint8_t> is_known_;  ///< row by row from `low_`
  std::vector<FloorSquare> squares_;
};

/// The same of whichever islands are asked for, found once each.
class KnownFloor {
 public:
  explicit KnownFloor(const Map& map) : map_(map) {}
  const KnownSquares& of(IslandId island);

 private:
  const Map& map_;
  std::map<IslandId, KnownSquares> known_;
};

}  // namespace helicoid
