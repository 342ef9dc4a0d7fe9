// The operator's word, kept: who is sent, paused or called home, and where nobody goes.
#pragma once

#include <map>
#include <span>

#include "helicoid/exploration/team.hpp"

namespace helicoid {

class OrderBook {
 public:
  void take(std::span<const Order> orders);

  /// What a robot was told to do; null: it explores.
  [[nodiscard]] const Order* of(RobotId robot) const;
  /// True if the place lies in a forbidden region of its island.
  [[nodiscard]] bool is_forbidden(const Map& map, const ManifoldPoint& point) const;
  [[nodiscard]] bool forbids_anything() const { return !forbidden_.empty(); }

 private:
  std::map<RobotId, Order> by_robot_;
  std::optional<Order> for_all_;  ///< given to those without an order of their own
  std::vector<Order> forbidden_;
};

}  // namespace helicoid
