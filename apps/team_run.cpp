#include "apps/team_run.hpp"

#include <algorithm>
#include <map>

#include "apps/interrupt_guard.hpp"

namespace helicoid {

namespace {

constexpr double kPeriod = 0.1;  // seconds between the poses of a trajectory

std::optional<std::size_t> find_island(const std::vector<TeamIsland>& islands,
                                       std::vector<std::size_t> TeamIsland::*members, std::size_t member) {
  for (std::size_t i = 0; i < islands.size(); ++i) {
    const auto& all = islands[i].*members;
    if (std::find(all.begin(), all.end(), member) != all.end()) return i;
  }
  return std::nullopt;
}

std::vector<TeamIsland> list_islands(const TeamFit& fit) {
  std::map<std::uint32_t, TeamIsland> islands;
  for (std::size_t i = 0; i < fit.nodes.robots(); ++i) {
    if (fit.nodes.stamps_of(i).empty()) continue;
    const std::uint32_t first = fit.nodes.first_of(i);
    TeamIsland& island = islands[fit.island_of[first]];
    if (island.robots.empty()) island.T_fit_island = fit.team.graph.poses[first];
    island.robots.push_back(i);
  }
  for (std::uint32_t node = fit.nodes.first_landmark(); node < fit.nodes.count(); ++node) {
    const auto island = islands.find(fit.island_of[node]);
    if (island != islands.end()) island->second.landmarks.push_back(node - fit.nodes.first_landmark());
  }
  std::vector<TeamIsland> list;
  list.reserve(islands.size());
  for (auto& [number, island] : islands) list.push_back(std::move(island));
  std::stable_sort(list.begin(), list.end(),
                   [](const TeamIsland& a, const TeamIsland& b) { return a.robots.size() > b.robots.size(); });
  return list;
}

}  // namespace

std::optional<std::size_t> TeamRun::island_of_robot(std::size_t robot) const {
  return find_island(islands, &TeamIsland::robots, robot);
}

std::optional<std::size_t> TeamRun::island_of_landmark(std::size_t landmark) const {
  return find_island(islands, &TeamIsland::landmarks, landmark);
}

Pose2 TeamRun::pose_of(std::uint32_t node) const {
  const bool landmark = fit.nodes.is_landmark(node);
  const auto island =
      landmark ? island_of_landmark(node - fit.nodes.first_landmark()) : island_of_robot(fit.nodes.robot_of(node));
  const Pose2& pose = fit.team.graph.poses[node];
  if (!island) return pose;
  const Pose2 T_island_node = islands[*island].T_fit_island.inverse() * pose;
  return {T_island_node.x, T_island_node.y, landmark ? 0 : T_island_node.yaw};
}

Result<TeamRun> run_team(const std::string& folder, const TeamFitOptions& options,
                         const std::function<void(double)>& progress) {
  const InterruptGuard guard;
  const auto began = std::chrono::steady_clock::now();
  const double start = thread_cpu_seconds();
  Result<MrclamFolder> read = read_mrclam(folder);
  if (!read) return tl::unexpected(read.error());
  const double opened = thread_cpu_seconds();
  TeamFit fit = fit_team(read->log, options, [&](double share) {
    if (progress) progress(share);
    return !InterruptGuard::interrupted();
  });
  TeamRun run{std::move(*read), std::move(fit), {}, {}, InterruptGuard::interrupted(), {}, began};
  run.islands = list_islands(run.fit);
  for (std::size_t i = 0; i < run.folder.log.robots.size(); ++i) {
    const auto island = run.island_of_robot(i);
    const Pose2 T_island_fit = island ? run.islands[*island].T_fit_island.inverse() : Pose2{};
    std::vector<StampedPose>& trajectory = run.trajectories.emplace_back();
    for (const StampedEstimate& e : poses_at(run.folder.log, run.fit, i, steady_stamps(run.fit, i, kPeriod))) {
      trajectory.push_back({e.stamp, T_island_fit * e.pose});
    }
  }
  run.phase.read = opened - start;
  run.phase.fit = thread_cpu_seconds() - opened;
  return run;
}

TeamError score_team(const MrclamFolder& folder, const TeamFit& fit) {
  std::vector<TeamTrack> tracks;
  for (std::size_t i = 0; i < folder.log.robots.size(); ++i) {
    TeamTrack& track = tracks.emplace_back();
    for (const StampedEstimate& e : poses_at(folder.log, fit, i, steady_stamps(fit, i, kPeriod))) {
      track.stamps.push_back(e.stamp);
      track.poses.push_back(e.pose);
    }
    for (const StampedPose& p : folder.truth[i]) {
      track.true_stamps.push_back(p.stamp);
      track.truth.push_back(p.pose);
    }
  }
  return team_error(tracks);
}

}  // namespace helicoid
