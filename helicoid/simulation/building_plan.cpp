#include "helicoid/simulation/building_plan.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace helicoid {

namespace {

constexpr int kKinds = 4;
/// Where a robot turns, at the room's middle, no piece reaches, metres from the door.
constexpr double kWayIn = 2.9;

Pose2 draw_place(const Room& room, Random& random) {
  const double x = random.uniform(0.7, room.width - 0.7);
  const double y = random.uniform(kWayIn, std::max(kWayIn, room.depth - 0.6));
  const double yaw = 0.5 * std::numbers::pi * static_cast<double>(random.below(4)) + 0.1 * random.normal();
  return room.T_world_room * Pose2{x, y, yaw};
}

}  // namespace

void BuildingPlan::wall(const Vector2d& a, const Vector2d& b, double thickness) {
  const Vector2d along = 0.5 * thickness * (b - a).normalized();
  const Vector2d across(-along.y(), along.x());
  const Vector2d corners[] = {a - along - across, b + along - across, b + along + across, a - along + across};
  for (std::size_t i = 0; i < 4; ++i) line(corners[i], corners[(i + 1) % 4]);
}

void BuildingPlan::wall_with_doors(const Vector2d& a, const Vector2d& b, std::span<const double> doors,
                                   double door_width) {
  const Vector2d along = (b - a).normalized();
  Vector2d from = a;
  for (const double door : doors) {
    wall(from, a + (door - 0.5 * door_width) * along);
    from = a + (door + 0.5 * door_width) * along;
  }
  wall(from, b);
}

void BuildingPlan::wall_with_niches(const Vector2d& a, const Vector2d& b, Random& random) {
  const double length = (b - a).norm();
  const Vector2d along = (b - a) / length;
  const Vector2d aside(-along.y(), along.x());
  double at = 0;
  Vector2d last = a;
  while (true) {
    const double begin = at + random.uniform(2.5, 8);
    const double end = begin + random.uniform(0.9, 1.8);
    if (end > length - 1) break;
    const double depth = random.uniform(0.1, 0.35);
    const Vector2d corners[] = {a + begin * along, a + begin * along + depth * aside, a + end * along + depth * aside,
                                a + end * along};
    for (const Vector2d& corner : corners) {
      line(last, corner);
      last = corner;
    }
    at = end;
  }
  line(last, b);
}

void BuildingPlan::box(const Pose2& T_world_middle, double length, double width) {
  const Vector2d half(0.5 * length, 0.5 * width);
  const Vector2d corners[] = {{-half.x(), -half.y()}, {half.x(), -half.y()}, half, {-half.x(), half.y()}};
  for (std::size_t i = 0; i < 4; ++i) line(T_world_middle * corners[i], T_world_middle * corners[(i + 1) % 4]);
}

void BuildingPlan::disc(const Vector2d& middle, double radius) {
  constexpr int kCorners = 10;
  const auto corner = [&](int i) {
    const double angle = 2 * std::numbers::pi * i / kCorners;
    return Vector2d(middle + radius * Vector2d(std::cos(angle), std::sin(angle)));
  };
  for (int i = 0; i < kCorners; ++i) line(corner(i), corner(i + 1));
}

std::vector<Room> add_rooms(BuildingPlan& plan, const RoomRow& row) {
  const double length = (row.to - row.from).norm();
  const Vector2d along = (row.to - row.from) / length;
  const Vector2d into(-along.y(), along.x());
  const auto count = std::max(1, static_cast<int>(std::floor(length / row.width)));
  const double width = length / count;
  std::vector<double> doors;
  std::vector<Room> rooms;
  for (int i = 0; i < count; ++i) {
    const Vector2d corner = row.from + i * width * along;
    const double door = (i + 0.5) * width;
    doors.push_back(door);
    const Vector2d at_door = row.from + door * along;
    rooms.push_back({at_door - 1.0 * into,
                     at_door,
                     at_door + 1.5 * into,
                     {corner.x(), corner.y(), std::atan2(along.y(), along.x())},
                     width,
                     row.depth});
  }
  plan.wall_with_doors(row.from, row.to, doors, row.door_width);
  plan.wall(row.from + row.depth * into, row.to + row.depth * into);
  for (int i = 0; i <= count; ++i) {
    const Vector2d at = row.from + i * width * along;
    plan.wall(at, at + row.depth * into);
  }
  return rooms;
}

std::vector<Piece> furnish(std::span<const Room> rooms, int pieces_in_room, Random random) {
  std::vector<Piece> pieces;
  for (const Room& room : rooms) {
    for (int i = 0; i < pieces_in_room; ++i) pieces.push_back({i % kKinds, draw_place(room, random)});
  }
  return pieces;
}

std::vector<Piece> rearranged(std::vector<Piece> pieces, std::span<const Room> rooms, std::size_t count,
                              Random random) {
  std::vector<std::size_t> left(pieces.size());
  for (std::size_t i = 0; i < left.size(); ++i) left[i] = i;
  for (std::size_t moved = 0; moved < count && !left.empty(); ++moved) {
    const std::size_t pick = random.below(left.size());
    const std::size_t piece = left[pick];
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(pick));
    const Vector2d before = pieces[piece].T_world_piece.translation();
    // Furniture is kept room by room. Elsewhere means at least a metre from where it stood.
    const Room& room = rooms[piece * rooms.size() / pieces.size()];
    do {
      pieces[piece].T_world_piece = draw_place(room, random);
    } while ((pieces[piece].T_world_piece.translation() - before).norm() < 1);
  }
  return pieces;
}

void add(BuildingPlan& plan, std::span<const Piece> pieces) {
  for (const Piece& piece : pieces) {
    switch (piece.kind) {
      case 0: plan.box(piece.T_world_piece, 1.1, 0.5); break;
      case 1: plan.box(piece.T_world_piece, 2.0, 0.9); break;
      case 2: plan.box(piece.T_world_piece, 1.2, 0.7); break;
      default: plan.disc(piece.T_world_piece.translation(), 0.2);
    }
  }
}

}  // namespace helicoid
