#include "helicoid/mapping/mapper.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <ctime>
#include <optional>

#include "helicoid/align/align_scan.hpp"
#include "helicoid/fit/fit_graph.hpp"
#include "helicoid/manifold/confidence.hpp"
#include "helicoid/manifold/map_editor.hpp"
#include "helicoid/mapping/induce.hpp"
#include "helicoid/mapping/loop_closer.hpp"
#include "helicoid/mapping/new_ground.hpp"
#include "helicoid/mapping/relate.hpp"
#include "helicoid/mapping/robot_state.hpp"

namespace helicoid {

namespace {

double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

bool has_moved(const Pose2& from, const Pose2& to, double distance, double angle) {
  return std::hypot(to.x - from.x, to.y - from.y) > distance || std::abs(wrap_angle(to.yaw - from.yaw)) > angle;
}

}  // namespace

struct Mapper::State {
  explicit State(const MapperOptions& o) : options(o), editor(map), closer(o) {}

  MapperOptions options;
  Map map;
  MapEditor editor;
  InformationGraph graph;
  LoopCloser closer;
  std::vector<RobotState> robots;
  MapperCounts counts;
  MapperTimes times;
  std::size_t relations_at_last_fit = 0;

  Step step(const Event& event, const Scan& scan);
  Step start_island(RobotState& robot, const Event& event, const Scan& scan);
  void renew_reference(RobotState& robot, const ScanPoints& points, const Pose2& T_anchor_robot);
  Alignment match(RobotState& robot, const ScanPoints& points, const PosePrior& prior, const LaserModel& laser);
  bool is_worth_keeping(RobotState& robot, const Alignment& alignment, const Scan& scan, std::size_t points,
                        const LaserModel& laser) const;
  void count(const Event& event, const Sighting& sighting);
  PatchId keep(RobotState& robot, const Event& event, const Scan& scan, const PosePrior& matched);
  void relate_to_last(RobotState& robot, PatchId id);
  void close_loops(PatchId id, const LocalMap& known);
  void add_relation(const Relation& relation);
  void reanchor(RobotState& robot);
  void fit_islands();
  const LaserModel& laser_of(RobotId robot, const Scan& scan) const { return map.robot(robot).lasers[scan.laser]; }
};

Step Mapper::State::step(const Event& event, const Scan& scan) {
  RobotState& robot = robots[event.robot.index()];
  const LaserModel& laser = laser_of(event.robot, scan);
  const Motion motion = robot.motion.advance(scan, event.stamp);
  ++counts.scans;
  if (motion.impossible) ++counts.odometry_jumps;
  if (!scan.has_odometry) ++counts.scans_without_odometry;
  if (!robot.pose.patch.valid()) return start_island(robot, event, scan);

  robot.T_kept_robot_raw = robot.T_kept_robot_raw * motion.T_last_now;
  robot.path += motion.T_last_now.distance();
  robot.turn += std::abs(motion.T_last_now.yaw);

  // Eq. 11: the predicted pose. Steps 2 to 4: the local map, the match, the fit.
  const Pose2 T_anchor_last = robot.pose.T_patch_robot;
  PosePrior prior{T_anchor_last * motion.T_last_now, robot.motion.information(motion)};
  const ScanPoints& points = robot.extractors[scan.laser].extract(scan);
  renew_reference(robot, points, prior.T_reference_scan);
  const Alignment alignment = match(robot, points, prior, laser);

  Step result;
  result.iterations = alignment.iterations;
  result.inlier_share = alignment.inlier_share;
  result.status = alignment.usable() ? StepStatus::matched : StepStatus::predicted;
  TrackedScan tracked;
  if (alignment.usable()) {
    ++counts.matched;
    robot.pose.T_patch_robot = alignment.T_reference_scan;
    robot.motion.learn(motion, T_anchor_last.inverse() * alignment.T_reference_scan);
  } else {
    ++counts.predicted;
    if (points.size() == 0) ++counts.empty_scans;
    robot.pose.T_patch_robot = prior.T_reference_scan;
  }
  const Matrix3d information =
      prior.information + (alignment.usable() ? Matrix3d(alignment.information / laser.kappa) : Matrix3d::Zero());
  tracked.covariance = information.inverse();

  const Pose2& T_anchor_robot = robot.pose.T_patch_robot;
  const bool keep_it = is_worth_keeping(robot, alignment, scan, points.size(), laser);
  if (keep_it) {
    result.new_patch = keep(robot, event, scan, {T_anchor_robot, information});
    tracked.covariance.setZero();
  }
  tracked.stamp = event.stamp;
  tracked.pose = robot.pose;
  tracked.T_island_robot_online = map.project(robot.pose);
  editor.append_scan(event.robot, tracked);
  result.pose = robot.pose;
  if (!keep_it) reanchor(robot);
  return result;
}

bool Mapper::State::is_worth_keeping(RobotState& robot, const Alignment& alignment, const Scan& scan,
                                     std::size_t points, const LaserModel& laser) const {
  const Pose2& T_anchor_robot = robot.pose.T_patch_robot;
  // A scan that saw next to nothing makes no patch: nothing could be matched to it.
  const bool sees = points >= static_cast<std::size_t>(AlignOptions{}.min_points);
  if (sees && is_far_from_all(robot.local, T_anchor_robot, options)) return true;
  if (!alignment.usable() || !is_far_from_all(robot.local, T_anchor_robot, options, options.apart_share)) return false;
  if (alignment.inlier_share < options.new_surface_share) return true;
  if (!has_moved(robot.T_anchor_coverage_view, T_anchor_robot, 0.25, 0.26)) return false;
  robot.T_anchor_coverage_view = T_anchor_robot;
  return uncovered_share(map, robot.local, T_anchor_robot, scan, laser) > options.new_ground_share;
}

void Mapper::State::count(const Event& event, const Sighting& sighting) {
  const std::string& self = map.robot(event.robot).name;
  const auto is_named = [&](const RobotRecord& r) { return r.name == sighting.observed; };
  if (sighting.observed == self) {
    ++counts.self_sightings;
  } else if (std::none_of(map.robots().begin(), map.robots().end(), is_named)) {
    ++counts.unidentified_sightings;
  } else {
    ++counts.sightings;
  }
}

Step Mapper::State::start_island(RobotState& robot, const Event& event, const Scan& scan) {
  const IslandId island = editor.add_island();
  const PatchId id = make_id<PatchId>(map.patch_count());
  editor.add_patch(make_patch(id, event.robot, map.robot(event.robot).trajectory.size(), event.stamp, scan,
                              laser_of(event.robot, scan)),
                   Pose2{}, island);
  graph.add_pose();
  robot.pose = {id, Pose2{}};
  robot.last_kept = id;
  robot.stale = true;
  editor.append_scan(event.robot, {event.stamp, robot.pose, Pose2{}, Matrix3d::Zero()});
  return {StepStatus::first, robot.pose, id, 0, 0};
}

void Mapper::State::renew_reference(RobotState& robot, const ScanPoints& points, const Pose2& T_anchor_robot) {
  if (!robot.stale && !has_moved(robot.T_anchor_reference_view, T_anchor_robot, options.reference_renewal,
                                 options.reference_renewal_turn)) {
    return;
  }
  if (robot.stale) {
    BoundOptions bound = bound_options(map.patch(robot.pose.patch), options.reference_position,
                                       options.reference_heading, options.local_radius);
    bound.most = options.local_patches;
    robot.local = find_local_map(map, graph, robot.pose.patch, bound);
    robot.T_anchor_coverage_view = T_anchor_robot;
    robot.stale = false;
  }
  std::vector<ReferencePart> parts;
  for (const LocalPatch& view :
       select_views(map, robot.local, points, T_anchor_robot, robot.last_kept, options.reference_views)) {
    parts.push_back({&map.patch(view.patch).points, view.T_anchor_patch});
  }
  robot.reference.build(parts);
  robot.T_anchor_reference_view = T_anchor_robot;
}

Alignment Mapper::State::match(RobotState& robot, const ScanPoints& points, const PosePrior& prior,
                               const LaserModel& laser) {
  AlignOptions align;
  align.kappa = laser.kappa;
  align.incidence_bias = laser.incidence_bias;
  Alignment alignment = align_scan(robot.reference, points, prior, align);
  if (robot.motion.in_doubt() || alignment.inlier_share < options.good_inlier_share) {
    const Motion steady = robot.motion.constant_velocity();
    const Alignment other =
        align_scan(robot.reference, points,
                   {robot.pose.T_patch_robot * steady.T_last_now, robot.motion.information(steady)}, align);
    if (other.usable() && other.inlier_share > alignment.inlier_share + 0.02) alignment = other;
  }
  if (alignment.status == AlignStatus::too_few_inliers || alignment.inlier_share < options.good_inlier_share) {
    const Alignment fan = align_scan_in_fan(robot.reference, points, prior, align);
    ++counts.coarse_searches;
    if (fan.usable() && fan.inlier_share > alignment.inlier_share) alignment = fan;
  }
  return alignment;
}

PatchId Mapper::State::keep(RobotState& robot, const Event& event, const Scan& scan, const PosePrior& matched) {
  const LaserModel& laser = laser_of(event.robot, scan);
  const PatchId anchor = robot.pose.patch;
  const PatchId id = make_id<PatchId>(map.patch_count());
  Patch patch = make_patch(id, event.robot, map.robot(event.robot).trajectory.size(), event.stamp, scan, laser);
  const std::vector<LocalPatch> views =
      select_views(map, robot.local, patch.points, matched.T_reference_scan, robot.last_kept, options.relation_views);
  RelateOptions relate_options;
  relate_options.kappa = laser.kappa;
  relate_options.match.incidence_bias = laser.incidence_bias;
  // The prior of the new patch's fit is odometry's only: the match's own beams must not count twice.
  const RelatedPatch related =
      relate(map, views, patch.points, {matched.T_reference_scan, 1e-3 * Matrix3d::Identity()}, relate_options);
  editor.add_patch(std::move(patch), map.T_plane_patch(anchor) * related.T_anchor_patch, map.island_of(anchor));
  graph.add_pose();
  for (const NewRelation& r : related.relations) {
    const RelationKind kind = r.patch == robot.last_kept ? RelationKind::chain : RelationKind::overlap;
    add_relation({r.patch, id, kind, r.form, r.T_a_b, r.c_min, 0.1, r.correspondences});
  }
  relate_to_last(robot, id);
  if (options.closures) close_loops(id, robot.local);
  // Eq. 15.
  robot.pose = {id, Pose2{}};
  robot.last_kept = id;
  robot.T_kept_robot_raw = Pose2{};
  robot.path = robot.turn = 0;
  robot.stale = true;
  return id;
}

void Mapper::State::close_loops(PatchId id, const LocalMap& known) {
  const double began = thread_seconds();
  constexpr int kRounds = 10;
  MapInProgress progress{map, editor, graph};
  std::vector<PatchId> touched;
  for (const std::size_t entry : closer.observe(map, graph, id, known)) {
    const std::vector<PatchId> tied = tie(progress, closer.ledger()[entry], options);
    touched.insert(touched.end(), tied.begin(), tied.end());
  }
  for (int round = 0; round < kRounds && !touched.empty(); ++round) {
    fit_islands();
    graph = information_graph(map);
    touched = induce(progress, touched, closer.along(), options);
  }
  times.close_s += thread_seconds() - began;
}

void Mapper::State::relate_to_last(RobotState& robot, PatchId id) {
  const Matrix3d information = robot.motion.path_information(robot.path, robot.turn);
  add_relation({robot.last_kept, id, RelationKind::odometry, pose_pose_form(robot.T_kept_robot_raw, information),
                robot.T_kept_robot_raw, 0, 0, 0});
}

void Mapper::State::add_relation(const Relation& relation) {
  editor.add_relation(relation);
  const Pose2 T_a_b = map.T_plane_patch(relation.a).inverse() * map.T_plane_patch(relation.b);
  graph.add(relation.a.value, relation.b.value, T_a_b,
            expand(relation.form, T_a_b).information / information_divisor(map, relation));
}

void Mapper::State::reanchor(RobotState& robot) {
  // Eq. 14: the nearest patch of the local map that overlaps; with hysteresis, so that the anchor does not flutter.
  constexpr double kHysteresis = 0.8;
  const std::vector<LocalPatch> nearest = nearest_views(robot.local, robot.pose.T_patch_robot, 1);
  const LocalPatch& best = nearest.front();
  if (best.patch == robot.pose.patch) return;
  const Pose2 T_best_robot = best.T_anchor_patch.inverse() * robot.pose.T_patch_robot;
  const Pose2& T_anchor_robot = robot.pose.T_patch_robot;
  const double now = T_anchor_robot.distance() + 1.5 * std::abs(T_anchor_robot.yaw);
  const double then = T_best_robot.distance() + 1.5 * std::abs(T_best_robot.yaw);
  if (then > kHysteresis * now - 0.05) return;
  robot.pose = {best.patch, T_best_robot};
  robot.stale = true;
}

void Mapper::State::fit_islands() {
  if (relations_at_last_fit == map.relations().size()) return;
  relations_at_last_fit = map.relations().size();
  for (const Island& island : map.islands()) {
    std::vector<Pose2> start;
    for (const PatchId id : island.patches) start.push_back(map.T_plane_patch(id));
    const std::vector<GraphEdge> edges = graph_edges(map, island);
    const FitResult fit = fit_graph(start, edges, 0);
    for (std::size_t i = 0; i < start.size(); ++i) editor.set_pose(island.patches[i], fit.poses[i]);
  }
  for (RobotState& robot : robots) robot.stale = true;
}

Mapper::Mapper(const MapperOptions& options) : state_(std::make_unique<State>(options)) {}
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
  if (const auto* scan = std::get_if<Scan>(&event.body)) return state_->step(event, *scan);
  if (const auto* sighting = std::get_if<Sighting>(&event.body)) state_->count(event, *sighting);
  return {};
}

void Mapper::finish() {
  const double began = thread_seconds();
  state_->fit_islands();
  state_->times.fit_s += thread_seconds() - began;
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
