#include "helicoid/mapping/decision.hpp"

#include <algorithm>
#include <cmath>

namespace helicoid {

namespace {

constexpr double kSameStamp = 5e-6;  ///< seconds

RobotAtStamp place_of(const Map& map, const Hypothesis& h, bool first) {
  if (h.seen) {
    const bool observer = first == h.seen->observer_first;
    return {observer ? map.robot(h.seen->observer).name : h.seen->observed, h.seen->stamp};
  }
  const Patch& patch = map.patch(first ? h.a : h.b);
  return {map.robot(patch.robot).name, patch.stamp};
}

bool is_same(const RobotAtStamp& x, const RobotAtStamp& y) {
  return std::abs(x.stamp - y.stamp) <= kSameStamp && x.robot == y.robot;
}

}  // namespace

RobotAtStamp first_place(const Map& map, const Hypothesis& h) {
  return place_of(map, h, true);
}
RobotAtStamp second_place(const Map& map, const Hypothesis& h) {
  return place_of(map, h, false);
}

bool is_about(const Decision& d, HypothesisSource source, const RobotAtStamp& a, const RobotAtStamp& b) {
  return d.source == source && ((is_same(d.a, a) && is_same(d.b, b)) || (is_same(d.a, b) && is_same(d.b, a)));
}

const Decision* find_decision(std::span<const Decision> decisions, const Map& map, const Hypothesis& h) {
  if (decisions.empty()) return nullptr;
  const RobotAtStamp a = first_place(map, h);
  const RobotAtStamp b = second_place(map, h);
  const auto found = std::find_if(decisions.rbegin(), decisions.rend(),
                                  [&](const Decision& d) { return is_about(d, h.source, a, b); });
  return found == decisions.rend() ? nullptr : &*found;
}

}  // namespace helicoid
