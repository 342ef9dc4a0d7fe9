#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <ctime>

#include "helicoid/manifold/confidence.hpp"
#include "helicoid/mapping/fit_islands.hpp"
#include "helicoid/mapping/join_on_sightings.hpp"
#include "helicoid/mapping/judge_sightings.hpp"
#include "helicoid/mapping/mapper_state.hpp"
#include "helicoid/mapping/match_again.hpp"
#include "helicoid/mapping/new_ground.hpp"
#include "helicoid/mapping/relate.hpp"
#include "helicoid/mapping/sighting_fit.hpp"
#include "helicoid/mapping/tie_neighbours.hpp"

namespace helicoid {

double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

Step Mapper::State::step(const Event& event, const Scan& scan) {
  RobotState& robot = robots[event.robot.index()];
  const LaserModel& laser = laser_of(event.robot, scan);
  const Motion motion = advance(robot, event, scan);
  if (!robot.at.pose.patch.valid()) return start_island(robot, event, scan);

  // Steps 2 to 4: the local map, the match, the fit.
  PosePrior prior = predict(robot, motion);
  const ScanPoints& points = robot.extractors[scan.laser].extract(scan);
  const Alignment alignment = find_robot(robot, points, prior, motion, laser);

  Step result;
  result.iterations = alignment.iterations;
  result.inlier_share = alignment.inlier_share;
  result.status = alignment.usable() ? StepStatus::matched : StepStatus::predicted;
  follow(robot, motion, prior, alignment, laser);
  if (points.size() == 0) ++counts.empty_scans;
  // Where no patch knows the robot's place, the scan makes one that does: r lies inside s (III-A).
  const std::optional<LocalPatch> ground = find_ground(robot);
  if ((!ground && alignment.usable()) || is_worth_keeping(robot, alignment, scan, points.size())) {
    result.new_patch = keep(robot, event, scan);
  } else if (ground) {
    stand_on(robot, *ground);
  }
  note_known_ground(robot, alignment);
  result.pose = robot.at.pose;
  editor.append_scan(event.robot,
                     {event.stamp, robot.at.pose, map.T_plane_patch(robot.at.pose.patch), robot.at.covariance});
  return result;
}

bool Mapper::State::is_worth_keeping(RobotState& robot, const Alignment& alignment, const Scan& scan,
                                     std::size_t points) const {
  const Pose2& T_anchor_robot = robot.at.pose.T_patch_robot;
  // Who has kept nothing for a while walks known ground: there it takes more, or every lap would fill in gaps that the
  // ones before it left by a little.
  const double more = robot.since_kept.path + options.patch_spacing / options.patch_turn * robot.since_kept.turn >
                              options.known_way * options.patch_spacing
                          ? options.known_ground_factor
                          : 1;
  // A scan that saw next to nothing makes no patch: nothing could be matched to it.
  const bool sees = points >= static_cast<std::size_t>(AlignOptions{}.min_points);
  if (sees && is_far_from_all(robot.at.local, T_anchor_robot, options, more)) return true;
  if (!alignment.usable() || !is_far_from_all(robot.at.local, T_anchor_robot, options, more * options.apart_share)) {
    return false;
  }
  if (1 - alignment.inlier_share > more * (1 - options.new_surface_share)) return true;
  if (!has_moved(robot.at.T_anchor_coverage_view, T_anchor_robot, 0.25, 0.26)) return false;
  robot.at.T_anchor_coverage_view = T_anchor_robot;
  const UncoveredShare share = uncovered_share(map, robot.at.local, T_anchor_robot, scan, robot.extractors[scan.laser]);
  return share.of_all > more * options.new_ground_share || share.of_near > options.new_ground_share;
}

void Mapper::State::take(const Event& event, const Sighting& sighting) {
  const std::string& self = map.robot(event.robot).name;
  if (sighting.observed == self) {
    ++counts.self_sightings;
    return;
  }
  const std::optional<RobotId> observed = robot_named(sighting.observed);
  ++(observed ? counts.sightings : counts.unidentified_sightings);
  if (is_usable(sighting)) {
    robots[event.robot.index()].seen.see(robots[event.robot.index()].T_odom_robot, event.stamp, sighting);
  }
  if (map.robots().size() > 1) sightings.add(event.robot, observed, event.stamp, sighting);
}

void Mapper::State::take(const Event& event, const Lookalike& alike) {
  const std::optional<RobotId> there = robot_named(alike.robot);
  ++(there ? counts.reported_lookalikes : counts.lookalikes_of_nobody);
  if (there) reported.add(event.robot, *there, event.stamp, alike);
}

std::optional<RobotId> Mapper::State::robot_named(const std::string& name) const {
  const auto robot =
      std::find_if(map.robots().begin(), map.robots().end(), [&](const RobotRecord& r) { return r.name == name; });
  if (robot == map.robots().end()) return std::nullopt;
  return make_id<RobotId>(static_cast<std::size_t>(robot - map.robots().begin()));
}

void Mapper::State::join_what_is_determined(bool last) {
  // Asking the clock alone would cost a few per cent of a scan.
  if (sightings.empty() && reported.waiting() == 0) return;
  const double began = thread_seconds();
  MapInProgress progress{map, editor, graph};
  bool changed = options.closures && reported.take_placed(progress, closer, last, options);
  if (sightings.place_waiting(map, graph, closer, options.decisions, last) || last) {
    const bool joined = join_on_sightings(progress, closer, sightings, last, options);
    const bool tied = options.closures && sighting_ties.tie(progress, closer, sightings, last, options);
    sighting_acted_on = sighting_acted_on || joined;
    changed = changed || joined || tied;
  }
  if (changed) {
    proposals.answer(map, closer);
    for (RobotState& robot : robots) robot.at.stale = true;
  }
  times.close_s += thread_seconds() - began;
}

Step Mapper::State::start_island(RobotState& robot, const Event& event, const Scan& scan) {
  const PatchId id = make_id<PatchId>(map.patch_count());
  editor.add_patch(make_patch(id, event.robot, map.robot(event.robot).trajectory.size(), event.stamp, scan,
                              robot.extractors[scan.laser]),
                   Pose2{}, editor.add_island());
  graph.add_pose();
  robot.at.pose = {id, Pose2{}};
  robot.last_kept = id;
  robot.since_kept = robot.since_known = DrivenWay(robot.at.pose);
  robot.at.stale = true;
  editor.append_scan(event.robot, {event.stamp, robot.at.pose, Pose2{}, Matrix3d::Zero()});
  return {StepStatus::first, robot.at.pose, id, 0, 0};
}

PatchId Mapper::State::keep(RobotState& robot, const Event& event, const Scan& scan) {
  const PatchId anchor = robot.at.pose.patch;
  const Pose2& T_anchor_robot = robot.at.pose.T_patch_robot;
  const PatchId id = make_id<PatchId>(map.patch_count());
  Patch patch = make_patch(id, event.robot, map.robot(event.robot).trajectory.size(), event.stamp, scan,
                           robot.extractors[scan.laser]);
  const std::vector<LocalPatch> views =
      select_views(map, robot.at.local, patch.points, T_anchor_robot, robot.last_kept, options.relation_views);
  // The new patch's fit is worth no more beforehand than odometry: the match's own beams must not count twice. What the
  // views leave open stays where the robot was followed to.
  const PosePrior prior{T_anchor_robot, robot.motion.path_information(robot.since_known.path, robot.since_known.turn)};
  RelatedPatch related = relate(map, views, patch, prior);
  editor.add_patch(std::move(patch), map.T_plane_patch(anchor) * related.T_anchor_patch, map.island_of(anchor));
  graph.add_pose();
  for (Relation& relation : related.relations) {
    if (relation.a == robot.last_kept) relation.kind = RelationKind::chain;
    add_relation(relation);
  }
  relate_to_last(robot, id);
  if (compares_places()) look_for_loops(id, robot.at.local);
  // Eq. 15.
  robot.at.pose = {id, Pose2{}};
  robot.at.covariance.setZero();
  robot.last_kept = id;
  robot.since_kept = robot.since_known = DrivenWay(robot.at.pose);
  robot.at.stale = true;
  return id;
}

void Mapper::State::look_for_loops(PatchId id, const LocalMap& known) {
  const double began = thread_seconds();
  MapInProgress progress{map, editor, graph};
  if (close_loops(progress, closer, id, known, options)) {
    for (RobotState& robot : robots) robot.at.stale = true;
  }
  times.close_s += thread_seconds() - began;
}

void Mapper::State::close_what_is_left() {
  const double began = thread_seconds();
  MapInProgress progress{map, editor, graph};
  fit_islands(map, editor);
  progress.graph = information_graph(map);
  if (compares_places()) close_loops_again(progress, closer, options);
  if (options.look_alikes) join_on_evidence(progress, closer, options.join_on_evidence, options);
  closer.follow_ways(map);
  tie_neighbours(progress, closer.along(), options);
  match_again(map, editor);
  times.close_s += thread_seconds() - began;
}

void Mapper::State::relate_to_last(RobotState& robot, PatchId id) {
  const auto relate_by = [&](const DrivenWay& way) {
    const UncertainPose2 end = way.end(robot.motion);
    add_relation({way.from.patch, id, RelationKind::odometry, pose_pose_form(end.T_a_b, end.covariance.inverse()),
                  end.T_a_b, 0, 0, 0});
  };
  relate_by(robot.since_kept);
  if (robot.since_known.from.patch != robot.since_kept.from.patch) relate_by(robot.since_known);
}

void Mapper::State::add_relation(const Relation& relation) {
  editor.add_relation(relation);
  const Pose2 T_a_b = map.T_plane_patch(relation.a).inverse() * map.T_plane_patch(relation.b);
  graph.add(relation.a.value, relation.b.value, T_a_b,
            expand(relation.form, T_a_b).information / information_divisor(map, relation));
}

Mapper::Mapper(const MapperOptions& options) : state_(std::make_unique<State>(options)) {}
Mapper::Mapper(const MapperOptions& options, Map map) : Mapper(options) {
  state_->go_on_from(std::move(map));
}
Mapper::~Mapper() = default;
Mapper::Mapper(Mapper&&) noexcept = default;
Mapper& Mapper::operator=(Mapper&&) noexcept = default;

RobotId Mapper::add_robot(const std::string& name, const std::vector<LaserModel>& lasers) {
  RobotState robot;
  for (const LaserModel& laser : lasers) robot.extractors.emplace_back(laser);
  state_->robots.push_back(std::move(robot));
  return state_->editor.add_robot(name, lasers);
}

Step Mapper::process(const Event& event) {
  if (const auto* scan = std::get_if<Scan>(&event.body)) {
    RobotState& robot = state_->robots[event.robot.index()];
    robot.T_odom_robot = scan->T_odom_robot;
    const std::optional<ClearedScan> cleared =
        robot.seen.clear(*scan, event.stamp, state_->laser_of(event.robot, *scan));
    if (cleared) state_->counts.returns_of_robots += cleared->removed;
    const Step step = state_->step(event, cleared ? cleared->scan : *scan);
    state_->join_what_is_determined(false);
    return step;
  }
  if (const auto* sighting = std::get_if<Sighting>(&event.body)) state_->take(event, *sighting);
  if (const auto* alike = std::get_if<Lookalike>(&event.body)) state_->take(event, *alike);
  return {};
}

void Mapper::propose() {
  State& s = *state_;
  if (!s.options.closures || !s.options.look_alikes) return;
  const double began = thread_seconds();
  MapInProgress progress{s.map, s.editor, s.graph};
  s.proposals.look(progress, s.closer, s.options);
  s.times.close_s += thread_seconds() - began;
}

void Mapper::decide(const Decision& decision) {
  State& s = *state_;
  s.options.decisions.push_back(decision);
  MapInProgress progress{s.map, s.editor, s.graph};
  const std::vector<std::size_t> accepted = s.closer.decide(s.map, decision);
  if (accepted.empty()) return;
  JoinTrials trials;
  act_on_or_join(progress, s.closer, accepted, trials, s.options);
  s.proposals.answer(s.map, s.closer);
  for (RobotState& robot : s.robots) robot.at.stale = true;
}

void Mapper::finish() {
  State& s = *state_;
  s.join_what_is_determined(true);
  s.counts.sightings_without_place = s.sightings.waiting();
  s.counts.lookalikes_of_nobody += s.reported.waiting();
  if (s.patches_at_last_fit == s.map.patch_count()) return;
  s.patches_at_last_fit = s.map.patch_count();
  if (s.options.closures) s.close_what_is_left();
  const double began = thread_seconds();
  fit_islands(s.map, s.editor);
  judge_sightings(s.map, s.closer, s.sightings);
  choose_origins(s.map, s.editor);
  s.graph = information_graph(s.map);
  for (RobotState& robot : s.robots) robot.at.stale = true;
  s.times.fit_s += thread_seconds() - began;
}

std::vector<Decision> Mapper::regrets(std::size_t passes) const {
  constexpr std::size_t kOneByOne = 4;  // passes
  const std::size_t most = std::size_t{1} << std::min<std::size_t>(passes > kOneByOne ? passes - kOneByOne : 0, 30);
  return find_regrets(state_->map, state_->graph, state_->closer, state_->sightings, most);
}

const std::vector<Decision>& Mapper::decisions() const {
  return state_->options.decisions;
}
const Map& Mapper::map() const {
  return state_->map;
}
const MapperCounts& Mapper::counts() const {
  return state_->counts;
}
const MapperTimes& Mapper::times() const {
  return state_->times;
}
const Ledger& Mapper::ledger() const {
  return state_->closer.ledger();
}

}  // namespace helicoid
