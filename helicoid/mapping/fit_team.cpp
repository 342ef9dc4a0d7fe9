#include "helicoid/mapping/fit_team.hpp"

#include <algorithm>
#include <cmath>

#include "helicoid/mapping/landmark_place.hpp"
#include "helicoid/mapping/team_calibration.hpp"

namespace helicoid {

namespace {

/// How far poses moved, root mean square.
double moved(std::span<const Pose2> before, std::span<const Pose2> after) {
  double squares = 0;
  for (std::size_t i = 0; i < before.size(); ++i)
    squares += (after[i].translation() - before[i].translation()).squaredNorm();
  return std::sqrt(squares / static_cast<double>(std::max<std::size_t>(1, before.size())));
}

/// The share of the work that is done when the start is.
constexpr double kStartShare = 0.5;

/// Fits with what is known of the robots now; wrong detections are those that are far off at the poses before.
TeamFit fit_round(const TeamLog& log, double gate, std::span<const Pose2> poses, TeamFit known) {
  TeamGraph whole = make_team_graph(log, known.nodes, known.model, poses);
  whole.graph.poses = reseat_landmarks(whole, find_wrong(log, whole, known.model, gate));
  const std::vector<bool> wrong = find_wrong(log, whole, known.model, gate);
  known.detections = whole.detections.size();
  known.wrong = static_cast<std::size_t>(std::count(wrong.begin(), wrong.end(), true));
  known.team = without(whole, wrong);
  known.result = fit(known.team.graph);
  known.team.graph.poses = known.result.poses;
  return known;
}

std::vector<std::uint32_t> islands_of(const RelationGraph& graph) {
  std::vector<std::uint32_t> island_of(graph.poses.size());
  std::uint32_t number = 0;
  for (const Component& component : find_components(graph)) {
    for (const std::uint32_t node : component.nodes) island_of[node] = number;
    ++number;
  }
  return island_of;
}

}  // namespace

TeamFit fit_team(const TeamLog& log, const TeamFitOptions& options, const std::function<bool(double)>& progress) {
  TeamModel model;
  model.odometry.resize(log.robots.size());
  model.detection.resize(log.robots.size());
  TeamFit done{TeamNodes(log, options.gap, options.landmarks), {}, model, {}, {}, 0, false, 0, 0, {}};
  bool goes_on = true;
  const auto tell = [&](double share) {
    if (progress) goes_on = progress(share) && goes_on;
  };
  done.start = start_team(done.nodes, make_team_graph(log, done.nodes, model), options.start, [&](double share) {
                 tell(kStartShare * share);
               }).poses;
  std::vector<Pose2> poses = done.start;
  while (done.rounds == 0 || (done.rounds < options.most_rounds && !done.is_still && goes_on)) {
    if (done.rounds > 0) {
      done.model = fit_variances(log, done.nodes, done.team, done.model);
      done.model.odometry = fit_gains(log, done.nodes, poses, done.model.odometry);
    }
    done = fit_round(log, options.gate, poses, std::move(done));
    // The first round only lets go what the start did not.
    done.is_still = done.rounds > 0 && moved(poses, done.result.poses) < options.still;
    poses = done.result.poses;
    ++done.rounds;
    tell(kStartShare + (1 - kStartShare) * (done.is_still ? 1 : 1 - std::pow(0.7, done.rounds)));
  }
  done.island_of = islands_of(done.team.graph);
  return done;
}

std::vector<StampedEstimate> poses_at(const TeamLog& log, const TeamFit& fit, std::size_t robot,
                                      std::span<const double> stamps) {
  const std::span<const double> nodes = fit.nodes.stamps_of(robot);
  const Pose2* poses = fit.team.graph.poses.data() + fit.nodes.first_of(robot);
  const CommandedMotion motion(log.robots[robot].velocities, fit.model.odometry[robot]);
  std::vector<StampedEstimate> estimates;
  for (const double stamp : stamps) {
    const auto after = std::upper_bound(nodes.begin(), nodes.end(), stamp) - nodes.begin();
    if (after == 0 || nodes.empty() || stamp > nodes.back()) continue;
    const std::size_t k = std::min<std::size_t>(static_cast<std::size_t>(after), nodes.size() - 1);
    if (k == 0 || stamp == nodes[k]) {
      estimates.push_back({stamp, poses[k]});
      continue;
    }
    const Pose2 reckoned = motion.between(nodes[k - 1], nodes[k]);
    const double share = (stamp - nodes[k - 1]) / (nodes[k] - nodes[k - 1]);
    const Vector3d lead = logarithm((poses[k - 1] * reckoned).inverse() * poses[k]);
    estimates.push_back({stamp, poses[k - 1] * motion.between(nodes[k - 1], stamp) * exponential(share * lead)});
  }
  return estimates;
}

std::vector<double> steady_stamps(const TeamFit& fit, std::size_t robot, double period) {
  const std::span<const double> nodes = fit.nodes.stamps_of(robot);
  std::vector<double> stamps;
  if (nodes.empty()) return stamps;
  // Where clocks run without a pose for hours, nothing is drawn in.
  std::size_t next = 0;
  for (double tick = std::ceil(nodes.front() / period); tick * period <= nodes.back(); ++tick) {
    const double stamp = tick * period;
    while (next < nodes.size() && nodes[next] < stamp) ++next;
    if (next > 0 && next < nodes.size() && nodes[next] - nodes[next - 1] > 10 * period) {
      tick = std::floor(nodes[next] / period) - 1;
      continue;
    }
    stamps.push_back(stamp);
  }
  return stamps;
}

}  // namespace helicoid
