#include "helicoid/simulation/radio.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace helicoid {

Radio::Radio(const World& world, std::size_t robots, RadioOptions options)
    : options_(std::move(options)),
      walls_(world.walls),
      waiting_(robots),
      in_contact_(robots, false),
      cut_seconds_(robots, 0.0) {}

std::vector<LiveEvent> Radio::pass(std::vector<LiveEvent> events, const LiveSimulation& simulation) {
  find_contacts(simulation);
  for (LiveEvent& event : events) waiting_[event.event.robot.index()].push_back(std::move(event));
  std::vector<LiveEvent> arrived;
  for (std::size_t i = 0; i < waiting_.size(); ++i) {
    if (simulation.alive(i) && !in_contact_[i]) cut_seconds_[i] += simulation.now() - last_;
    if (!in_contact_[i]) continue;
    std::move(waiting_[i].begin(), waiting_[i].end(), std::back_inserter(arrived));
    waiting_[i].clear();
  }
  last_ = simulation.now();
  return arrived;
}

std::vector<LiveEvent> Radio::hand_over() {
  std::vector<LiveEvent> all;
  for (std::vector<LiveEvent>& events : waiting_) {
    std::move(events.begin(), events.end(), std::back_inserter(all));
    events.clear();
  }
  return all;
}

bool Radio::is_cut(std::size_t robot, double now) const {
  return std::any_of(options_.cuts.begin(), options_.cuts.end(), [&](const RadioCut& cut) {
    const bool meant = cut.robots.empty() || std::find(cut.robots.begin(), cut.robots.end(), robot) != cut.robots.end();
    return meant && now >= cut.from && now < cut.to;
  });
}

bool Radio::reaches(const Vector2d& from, const Vector2d& to) const {
  constexpr double kPast = 1e-6;  // a face that was met, metres
  const double distance = (to - from).norm();
  double range = options_.range;
  if (distance > range) return false;
  if (options_.wall_loss <= 0 || distance == 0) return true;
  const Vector2d direction = (to - from) / distance;
  for (double at = 0; at < distance;) {
    const RayCaster::Hit hit = walls_.cast(from + at * direction, direction, distance - at);
    if (hit.segment < 0) return true;
    range -= options_.wall_loss;
    if (distance > range) return false;
    at += hit.distance + kPast;
  }
  return true;
}

/// From the base outwards, hop by hop.
void Radio::find_contacts(const LiveSimulation& simulation) {
  in_contact_.assign(waiting_.size(), false);
  std::vector<Vector2d> open{options_.p_world_base};
  while (!open.empty()) {
    const Vector2d from = open.back();
    open.pop_back();
    for (std::size_t i = 0; i < waiting_.size(); ++i) {
      if (in_contact_[i] || !simulation.alive(i) || is_cut(i, simulation.now())) continue;
      const Vector2d to = simulation.T_world_robot(i).translation();
      if (!reaches(from, to)) continue;
      in_contact_[i] = true;
      open.push_back(to);
    }
  }
}

}  // namespace helicoid
