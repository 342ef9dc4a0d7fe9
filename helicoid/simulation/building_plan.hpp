// Buildings made by rule instead of drawn: walls with doors, and furniture that may stand elsewhere on another day.
#pragma once

#include "helicoid/base/random.hpp"
#include "helicoid/simulation/world.hpp"

namespace helicoid {

struct BuildingPlan {
  std::vector<Segment> walls;

  void line(const Vector2d& a, const Vector2d& b) { walls.push_back({a, b}); }
  /// A wall with two faces, half of the thickness to each side of its line.
  void wall(const Vector2d& a, const Vector2d& b, double thickness = 0.12);
  /// The same with openings, by the distances of their middles from a; metres.
  void wall_with_doors(const Vector2d& a, const Vector2d& b, std::span<const double> doors, double door_width);
  /// Alternating between the line and niches of 10 to 35 cm to its left, at irregular distances.
  void wall_with_niches(const Vector2d& a, const Vector2d& b, Random& random);
  void box(const Pose2& T_world_middle, double length, double width);
  void disc(const Vector2d& middle, double radius);
};

/// Rows of like rooms along one side of a corridor.
struct RoomRow {
  Vector2d from, to;      ///< the corridor's wall
  double depth = 5;       ///< of the rooms, to the left of from-to, metres
  double width = 4;       ///< of a room at least, metres
  double door_width = 1;  ///< metres
};

/// What stands in a room or in front of it: which piece, and where.
struct Piece {
  int kind = 0;
  Pose2 T_world_piece;
};

/// A place in a room that a robot visits, and the door on the way.
struct Room {
  Vector2d before_door, door, middle;
  Pose2 T_world_room;  ///< its corner by the corridor; x along the corridor, y into the room
  double width = 0, depth = 0;
};

/// Adds the row's walls; its rooms in order.
std::vector<Room> add_rooms(BuildingPlan& plan, const RoomRow& row);

/// Beds, cupboards, tables and bins in the back of each room, from a seed: the same seed, the same places.
[[nodiscard]] std::vector<Piece> furnish(std::span<const Room> rooms, int pieces_in_room, Random random);
/// `count` of the pieces, at most all of them, put elsewhere in their rooms; the rest as they were.
[[nodiscard]] std::vector<Piece> rearranged(std::vector<Piece> pieces, std::span<const Room> rooms, std::size_t count,
                                            Random random);
void add(BuildingPlan& plan, std::span<const Piece> pieces);

}  // namespace helicoid
