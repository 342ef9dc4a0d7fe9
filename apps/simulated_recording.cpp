#include "apps/simulated_recording.hpp"

#include <algorithm>
#include <filesystem>

#include "apps/world_picture.hpp"
#include "helicoid/base/whole_file.hpp"
#include "helicoid/io/carmen_writer.hpp"
#include "helicoid/io/gzip_file.hpp"
#include "helicoid/io/trajectory.hpp"
#include "helicoid/simulation/simulator.hpp"

namespace helicoid {

namespace fs = std::filesystem;

namespace {

std::string true_trajectory(const TrueTrack& track) {
  std::vector<StampedPose> poses;
  for (std::size_t i = 0; i < track.stamps.size(); ++i) poses.push_back({track.stamps[i], track.T_world_robot[i]});
  return to_tum(poses);
}

}  // namespace

SimulatedRecording::SimulatedRecording(std::size_t robots, const std::string& maker)
    : logs_(robots, "# a log of `helicoid " + maker + "`\n") {
  for (std::size_t i = 0; i < robots; ++i) tracks_.push_back({simulated_robot_name(i), {}, {}});
}

void SimulatedRecording::note(const Event& event, const Pose2& T_world_robot) {
  const std::size_t robot = event.robot.index();
  append_carmen(logs_[robot], event, "simulation");
  if (!begun_) first_ = event.stamp;
  begun_ = true;
  last_ = std::max(last_, event.stamp);
  if (std::holds_alternative<Sighting>(event.body)) ++sightings_;
  if (std::holds_alternative<Odometry>(event.body)) ++odometry_;
  if (!std::holds_alternative<Scan>(event.body)) return;
  ++scans_;
  TrueTrack& track = tracks_[robot];
  if (!track.stamps.empty()) metres_ += (track.T_world_robot.back().inverse() * T_world_robot).distance();
  track.stamps.push_back(event.stamp);
  track.T_world_robot.push_back(T_world_robot);
}

Result<void> SimulatedRecording::write(const World& world, const std::string& folder) const {
  std::error_code error;
  fs::create_directories(fs::path(folder) / "truth", error);
  const std::string base = folder + "/";
  for (std::size_t i = 0; i < logs_.size(); ++i) {
    const std::string& robot = tracks_[i].robot;
    if (auto done = write_gzip_file(base + robot + ".clf.gz", logs_[i]); !done) return done;
    if (auto done = write_whole_file(base + "truth/" + robot + ".tum", true_trajectory(tracks_[i])); !done) return done;
  }
  if (auto done = write_whole_file(base + "world.yaml", to_yaml(world)); !done) return done;
  if (auto done = write_whole_file(base + "world.svg", draw_world(world, tracks_)); !done) return done;
  for (std::size_t i = logs_.size(); fs::remove(base + simulated_robot_name(i) + ".clf.gz", error); ++i) {
  }
  return {};
}

}  // namespace helicoid
