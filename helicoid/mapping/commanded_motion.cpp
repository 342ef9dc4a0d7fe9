#include "helicoid/mapping/commanded_motion.hpp"

#include <algorithm>

namespace helicoid {

namespace {

/// Nobody repeats a command less often while it holds.
constexpr double kLongestCommand = 2;  // seconds

}  // namespace

/// Calls visit(velocity, seconds) for each stretch of one command.
template <class Visit>
void CommandedMotion::for_each_piece(double from, double to, Visit&& visit) const {
  from -= model_.delay;
  to -= model_.delay;
  auto next = std::upper_bound(velocities_.begin(), velocities_.end(), from,
                               [](double stamp, const Velocity& v) { return stamp < v.stamp; });
  for (double at = from; at < to;) {
    const double until = next == velocities_.end() ? to : std::min(to, next->stamp);
    if (next != velocities_.begin()) {
      const Velocity& told = *(next - 1);
      const double end = std::min(until, told.stamp + kLongestCommand);
      if (end > at) visit(told, end - at);
    }
    at = until;
    if (next != velocities_.end()) ++next;
  }
}

Pose2 CommandedMotion::between(double from, double to) const {
  Pose2 T_from_at;
  for_each_piece(from, to, [&](const Velocity& v, double seconds) {
    const double turning = model_.turning_gain * v.turning + model_.veer * v.forward;
    const Vector3d twist(model_.forward_gain * v.forward, model_.sideways_gain * v.forward, turning);
    T_from_at = T_from_at * exponential(seconds * twist);
  });
  return T_from_at;
}

Commanded CommandedMotion::told(double from, double to) const {
  Commanded sum;
  for_each_piece(from, to, [&](const Velocity& v, double seconds) {
    sum.forward += v.forward * seconds;
    sum.turning += v.turning * seconds;
  });
  return sum;
}

}  // namespace helicoid
