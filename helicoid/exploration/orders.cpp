#include "helicoid/exploration/orders.hpp"

#include "helicoid/navigation/navigable_map.hpp"

namespace helicoid {

const char* name_of(GoalKind kind) {
  switch (kind) {
    case GoalKind::stay: return "stay";
    case GoalKind::frontier: return "frontier";
    case GoalKind::rendezvous: return "rendezvous";
    case GoalKind::revisit: return "revisit";
    case GoalKind::home: return "home";
    case GoalKind::operator_: break;
  }
  return "operator";
}

void OrderBook::take(std::span<const Order> orders) {
  for (const Order& order : orders) {
    if (order.kind == OrderKind::forbid) {
      forbidden_.push_back(order);
    } else if (order.robot.valid()) {
      by_robot_[order.robot] = order;
    } else {
      by_robot_.clear();
      for_all_ = order;
    }
  }
}

const Order* OrderBook::of(RobotId robot) const {
  const auto own = by_robot_.find(robot);
  const Order* order = own != by_robot_.end() ? &own->second : for_all_ ? &*for_all_ : nullptr;
  return order != nullptr && order->kind != OrderKind::resume ? order : nullptr;
}

bool OrderBook::is_forbidden(const Map& map, const ManifoldPoint& point) const {
  for (const Order& order : forbidden_) {
    const PatchId frame = order.point.patch;
    if (map.island_of(frame) != map.island_of(point.patch)) continue;
    const Pose2 T_frame_point = map.T_plane_patch(frame).inverse() * map.T_plane_patch(point.patch);
    if (lies_in(order.region_patch, T_frame_point * point.p_patch)) return true;
  }
  return false;
}

}  // namespace helicoid
