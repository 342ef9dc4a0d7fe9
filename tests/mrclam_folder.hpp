// A folder as the MRCLAM collection has them, for tests: three robots, four landmarks, a few lines.
#pragma once

#include <fmt/format.h>

#include <iterator>
#include <map>
#include <string>

#include "helicoid/sensor/team_log.hpp"

namespace helicoid::mrclam {

/// File names and their texts.
using Files = std::map<std::string, std::string>;

/// Barcodes are ten times the subject.
inline Files small_folder() {
  Files files;
  files["Barcodes.dat"] = "# Subject #    Barcode #\n 1 10\n 2 20\n 3 30\n 6 60\n 7 70\n";
  for (const char* robot : {"Robot1", "Robot2", "Robot3"}) {
    files[fmt::format("{}_Odometry.dat", robot)] = "# t v w\n100.0 0.1 0.2\n100.1\t0.1\t-0.2\n";
    files[fmt::format("{}_Measurement.dat", robot)] = "# t barcode r b\n100.05 60 2.5 0.1\n100.05 70 1.5 -0.1\n";
    files[fmt::format("{}_Groundtruth.dat", robot)] = "# t x y yaw\n100.0 1 2 4\n100.1 1.01 2 4\n";
  }
  files["Robot1_Measurement.dat"] += "100.2 20 3 0\n";
  files["Landmark_Groundtruth.dat"] = "# subject x y sx sy\n 6 1.5 -2 0.001 0.001\n 7 0 0 0.001 0.001\n";
  return files;
}

/// A log as such a folder. Subjects: robots from 1 on, landmarks from 6 on.
inline Files files_of(const TeamLog& log) {
  const auto robots = static_cast<std::uint32_t>(log.robots.size());
  const auto barcode = [&](std::uint32_t subject) {
    return 10 * (subject < robots ? subject + 1 : subject - robots + 6);
  };
  Files files;
  std::string& barcodes = files["Barcodes.dat"] = "# Subject #    Barcode #\n";
  for (std::uint32_t i = 0; i < robots + log.landmarks.size(); ++i)
    barcodes += fmt::format("{} {}\n", barcode(i) / 10, barcode(i));
  for (std::uint32_t i = 0; i < robots; ++i) {
    std::string& odometry = files[fmt::format("Robot{}_Odometry.dat", i + 1)] = "# t v w\n";
    for (const Velocity& v : log.robots[i].velocities) {
      fmt::format_to(std::back_inserter(odometry), "{:.3f} {:.3f} {:.3f}\n", v.stamp, v.forward, v.turning);
    }
    std::string& seen = files[fmt::format("Robot{}_Measurement.dat", i + 1)] = "# t barcode r b\n";
    for (const Detection& d : log.robots[i].detections) {
      fmt::format_to(std::back_inserter(seen), "{:.3f} {} {:.3f} {:.3f}\n", d.stamp, barcode(d.subject), d.range,
                     d.bearing);
    }
  }
  return files;
}

}  // namespace helicoid::mrclam
