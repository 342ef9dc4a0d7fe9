#include "helicoid/exploration/look_memory.hpp"

#include <algorithm>

namespace helicoid {

bool LookMemory::is_same(const Map& map, const ManifoldPoint& middle, const ManifoldPoint& other) const {
  return map.island_of(middle.patch) == map.island_of(other.patch) &&
         (project(map, middle) - project(map, other)).norm() <= options_.same;
}

LookMemory::Going* LookMemory::going(RobotId robot) {
  const auto found = std::find_if(going_.begin(), going_.end(), [&](const Going& g) { return g.robot == robot; });
  return found != going_.end() ? &*found : nullptr;
}

const ManifoldPoint* LookMemory::going_to(RobotId robot) const {
  const auto found = std::find_if(going_.begin(), going_.end(), [&](const Going& g) { return g.robot == robot; });
  return found != going_.end() ? &found->middle : nullptr;
}

const LookMemory::Verdict* LookMemory::find_verdict(const Map& map, const ManifoldPoint& middle) const {
  const auto found = std::find_if(verdicts_.begin(), verdicts_.end(),
                                  [&](const Verdict& v) { return is_same(map, v.middle, middle); });
  return found != verdicts_.end() ? &*found : nullptr;
}

LookMemory::Verdict& LookMemory::verdict_on(const Map& map, const ManifoldPoint& middle) {
  for (Verdict& verdict : verdicts_) {
    if (is_same(map, verdict.middle, middle)) return verdict;
  }
  return verdicts_.emplace_back(Verdict{middle, 0, 0, 0, 0});
}

void LookMemory::note_not_going(RobotId robot) {
  std::erase_if(going_, [&](const Going& g) { return g.robot == robot; });
}

void LookMemory::note_going(double now, const Map& map, RobotId robot, const Frontier& frontier, double way) {
  Going* at = going(robot);
  if (at == nullptr || !is_same(map, at->middle, frontier.middle)) {
    note_not_going(robot);
    const double deadline = now + options_.patience + way / options_.slowest;
    going_.push_back({robot, frontier.middle, deadline, way, now, -1, {}});
    at = &going_.back();
  }
  // Edges move a little as the map grows: the same one is followed.
  at->middle = frontier.middle;
  if (way < at->least_way - options_.nearer || way > at->least_way + options_.detour) {
    at->least_way = way;
    at->nearer_since = now;
  }
  if (way <= options_.arrived) {
    const bool advanced = at->there_since >= 0 &&
                          (project(map, at->middle_there) - project(map, frontier.middle)).norm() > options_.advanced;
    if (at->there_since < 0 || advanced) {
      at->there_since = now;
      at->middle_there = frontier.middle;
    }
    if (now - at->there_since < options_.look_time) return;
    Verdict& verdict = verdict_on(map, frontier.middle);
    ++verdict.looks;
    verdict.gain_m2 = frontier.gain_m2;
    note_not_going(robot);
  } else if (now > at->deadline || now - at->nearer_since > options_.stalled) {
    Verdict& verdict = verdict_on(map, frontier.middle);
    ++verdict.failures;
    verdict.rests_until = now + options_.rest;
    note_not_going(robot);
  }
}

bool LookMemory::is_resting(double now, const Map& map, const Frontier& frontier) const {
  const Verdict* verdict = find_verdict(map, frontier.middle);
  return verdict != nullptr && verdict->looks == 0 && verdict->failures < options_.most_tries &&
         now < verdict->rests_until;
}

bool LookMemory::is_let_be(double now, const Map& map, const Frontier& frontier) const {
  const Verdict* verdict = find_verdict(map, frontier.middle);
  if (verdict == nullptr) return false;
  const bool shows_no_more = verdict->looks > 0 && frontier.gain_m2 < verdict->gain_m2 + options_.more_gain;
  return shows_no_more || verdict->failures >= options_.most_tries || now < verdict->rests_until;
}

}  // namespace helicoid
