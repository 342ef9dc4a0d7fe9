#include "helicoid/simulation/buildings.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace helicoid {

namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kRingRadius = 16;  // of a round corridor's middle, metres
constexpr double kRingHalf = 1.2;   // of its width

void visit(Route& route, const Room& room) {
  route.points.insert(route.points.end(), {room.before_door, room.door, room.middle, room.door, room.before_door});
}

/// A block of the building that no robot enters, its walls with niches.
void add_block(BuildingPlan& plan, const Vector2d& low, const Vector2d& high, Random& random) {
  const Vector2d corners[] = {low, {high.x(), low.y()}, high, {low.x(), high.y()}};
  for (std::size_t i = 0; i < 4; ++i) plan.wall_with_niches(corners[i], corners[(i + 1) % 4], random);
}

/// The same from inside.
void add_hull(BuildingPlan& plan, const Vector2d& low, const Vector2d& high, Random& random) {
  const Vector2d corners[] = {low, {low.x(), high.y()}, high, {high.x(), low.y()}};
  for (std::size_t i = 0; i < 4; ++i) plan.wall_with_niches(corners[i], corners[(i + 1) % 4], random);
}

World finished(BuildingPlan plan, Route route, const char* name) {
  World world;
  world.name = name;
  world.walls = std::move(plan.walls);
  const Vector2d ahead = route.points[1] - route.points[0];
  world.starts.push_back({route.points[0].x(), route.points[0].y(), std::atan2(ahead.y(), ahead.x())});
  world.routes.push_back(std::move(route));
  return world;
}

/// Every third of the rooms from the given one on, in the order given.
void visit_some(Route& route, std::span<const Room> rooms, std::size_t first) {
  for (std::size_t i = first; i < rooms.size(); i += 3) visit(route, rooms[i]);
}

/// One rack: pallets side by side on posts, some places empty.
void add_rack(BuildingPlan& plan, const Vector2d& corner, int pallets, Random& random) {
  constexpr double kPitch = 1.35;
  for (int i = 0; i <= pallets; ++i) {
    for (const double y : {0.0, 1.2}) plan.box({corner.x() + i * kPitch, corner.y() + y, 0}, 0.1, 0.1);
    if (i < pallets && random.chance(0.7)) {
      plan.box({corner.x() + (i + 0.5) * kPitch, corner.y() + 0.6 + random.uniform(-0.1, 0.1), 0.05 * random.normal()},
               1.1, 0.9);
    }
  }
}

Vector2d on_circle(double radius, double angle) {
  return radius * Vector2d(std::cos(angle), std::sin(angle));
}

/// An arc with niches that are `deeper` metres farther out (or in, below 0).
void add_arc(BuildingPlan& plan, double radius, double from, double to, double deeper, Random& random) {
  double niche = from + random.uniform(0.15, 0.4);
  Vector2d last = on_circle(radius, from);
  for (double angle = from; angle < to;) {
    angle = std::min(to, angle + 0.04);
    const bool inside = angle > niche && angle < niche + 1.3 / radius && angle < to - 0.1;
    if (angle > niche + 1.3 / radius) niche = angle + random.uniform(0.15, 0.45);
    const double r = inside ? radius + deeper : radius;
    if (std::abs(last.norm() - r) > 1e-6) {
      plan.line(last, last.normalized() * r);
      last = last.normalized() * r;
    }
    plan.line(last, on_circle(r, angle));
    last = on_circle(r, angle);
  }
  plan.line(last, on_circle(radius, to));
}

}  // namespace

World make_hospital(std::uint64_t seed, std::size_t moved) {
  constexpr double kLength = 60;
  constexpr double kHeight = 15;
  constexpr double kHalf = 1.2;  // of the corridor's width
  BuildingPlan plan;
  std::vector<Room> south = add_rooms(plan, {{kLength + kHalf, -kHalf}, {-kHalf, -kHalf}});
  std::reverse(south.begin(), south.end());  // from west to east, as the robot comes by
  std::vector<Room> north = add_rooms(plan, {{-kHalf, kHeight + kHalf}, {kLength + kHalf, kHeight + kHalf}});
  std::reverse(north.begin(), north.end());
  constexpr double kCore = 0.5 * kHeight - kHalf;
  std::vector<Room> core = add_rooms(plan, {{kHalf, kHalf}, {kLength - kHalf, kHalf}, kCore});
  const std::vector<Room> core_north =
      add_rooms(plan, {{kLength - kHalf, kHeight - kHalf}, {kHalf, kHeight - kHalf}, kCore});
  plan.wall({-kHalf, -kHalf}, {-kHalf, kHeight + kHalf});
  plan.wall({kLength + kHalf, -kHalf}, {kLength + kHalf, kHeight + kHalf});

  Route route{{{0, 0}}, true};
  visit_some(route, south, 1);
  route.points.insert(route.points.end(), {{kLength, 0}, {kLength, kHeight}});
  visit_some(route, north, 0);
  route.points.emplace_back(0, kHeight);

  std::vector<Room> rooms = south;
  for (const std::vector<Room>& row : {north, core, core_north}) rooms.insert(rooms.end(), row.begin(), row.end());
  Random random(seed);
  const std::vector<Piece> pieces = furnish(rooms, 3, random.split());
  add(plan, rearranged(pieces, rooms, moved, random.split()));
  return finished(std::move(plan), std::move(route), "hospital");
}

World make_terminal(std::uint64_t seed) {
  constexpr double kLength = 250;
  constexpr double kHeight = 60;
  constexpr double kCross = 100;
  constexpr double kHalf = 1.5;
  Random random(seed);
  BuildingPlan plan;
  add_hull(plan, {-kHalf, -kHalf}, {kLength + kHalf, kHeight + kHalf}, random);
  add_block(plan, {kHalf, kHalf}, {kCross - kHalf, kHeight - kHalf}, random);
  add_block(plan, {kCross + kHalf, kHalf}, {kLength - kHalf, kHeight - kHalf}, random);
  return finished(
      std::move(plan),
      {{{0, 0}, {kLength, 0}, {kLength, kHeight}, {0, kHeight}, {0, 0}, {kCross, 0}, {kCross, kHeight}, {0, kHeight}},
       true},
      "terminal");
}

World make_warehouse(std::uint64_t seed) {
  constexpr double kLength = 54;
  constexpr double kHeight = 30;
  constexpr double kAisle = 3.8;  // from rack to rack
  constexpr int kRows = 7;
  Random random(seed);
  BuildingPlan plan;
  add_hull(plan, {0, 0}, {kLength, kHeight}, random);
  Route route{{{2, 1.7}}, true};
  for (int row = 0; row < kRows; ++row) {
    for (const double x : {4.0, 29.0}) add_rack(plan, {x, 2.9 + row * kAisle}, 15, random);
    const double aisle = 1.7 + row * kAisle;
    const bool east = row % 2 == 0;
    route.points.emplace_back(east ? 2 : kLength - 2, aisle);
    route.points.emplace_back(east ? kLength - 2 : 2, aisle);
  }
  route.points.insert(route.points.end(), {{kLength - 2, kHeight - 1.7}, {26.7, kHeight - 1.7}, {26.7, 1.7}});
  return finished(std::move(plan), std::move(route), "warehouse");
}

World make_dormitory(std::uint64_t seed) {
  constexpr double kLength = 64;
  constexpr double kHalf = 1.1;
  BuildingPlan plan;
  const std::vector<Room> north = add_rooms(plan, {{0, kHalf}, {kLength, kHalf}});
  const std::vector<Room> south = add_rooms(plan, {{kLength, -kHalf}, {0, -kHalf}});
  plan.wall({0, -kHalf}, {0, kHalf});
  plan.wall({kLength, -kHalf}, {kLength, kHalf});
  Route route{{{1, 0}}, true};
  for (const std::vector<Room>& row : {north, south}) {
    for (const Room& room : row) {
      visit(route, room);
      add(plan, furnish({&room, 1}, 3, Random(seed)));
    }
  }
  return finished(std::move(plan), std::move(route), "dormitory");
}

World make_rotunda(std::uint64_t seed) {
  constexpr double kRadius = kRingRadius;
  constexpr double kHalf = kRingHalf;
  Random random(seed);
  BuildingPlan plan;
  add_arc(plan, kRadius + kHalf, 0, kTurn, 0.3, random);
  const double inner = kRadius - kHalf;
  const double mouth = std::asin(kHalf / inner);
  for (const double from : {0.0, std::numbers::pi}) {
    add_arc(plan, inner, from + mouth, from + std::numbers::pi - mouth, -0.3, random);
    plan.wall_with_niches(on_circle(inner, from + std::numbers::pi - mouth), on_circle(inner, from + mouth), random);
  }
  Route route{{}, true};
  constexpr int kSteps = 48;
  for (int i = 0; i <= kSteps; ++i) route.points.push_back(on_circle(kRadius, kTurn * i / kSteps));
  for (int i = kSteps / 2; i < kSteps; ++i) route.points.push_back(on_circle(kRadius, kTurn * i / kSteps));
  return finished(std::move(plan), std::move(route), "rotunda");
}

World make_smooth_ring() {
  constexpr int kCorners = 360;
  BuildingPlan plan;
  Route route{{}, true};
  for (int i = 0; i < kCorners; ++i) {
    const double from = kTurn * i / kCorners;
    const double to = kTurn * (i + 1) / kCorners;
    for (const double r : {kRingRadius - kRingHalf, kRingRadius + kRingHalf}) {
      plan.line(on_circle(r, from), on_circle(r, to));
    }
    if (i % 8 == 0) route.points.push_back(on_circle(kRingRadius, from));
  }
  return finished(std::move(plan), std::move(route), "smooth ring");
}

std::vector<Segment> cupboard_in_ring(double angle) {
  BuildingPlan plan;
  const Vector2d at = on_circle(kRingRadius + kRingHalf - 0.25, angle);
  plan.box({at.x(), at.y(), angle}, 0.5, 0.8);
  return plan.walls;
}

}  // namespace helicoid
