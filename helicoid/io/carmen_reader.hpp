// CARMEN logs: one message a line, in the order of the file. Parsed without copies; no line allocates.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "helicoid/base/result.hpp"
#include "helicoid/io/laser_recognition.hpp"
#include "helicoid/io/number.hpp"
#include "helicoid/io/skipped.hpp"
#include "helicoid/io/text_file.hpp"
#include "helicoid/sensor/event.hpp"

namespace helicoid {

/// Reads FLASER, ROBOTLASER1, RAWLASER1, ODOM and SIGHTING; counts everything else (PARAM, SYNC and comments are known
/// to carry nothing for a map and are passed over).
class CarmenReader {
 public:
  /// The files of one robot, in their order. The whole text is looked through once for its lasers.
  CarmenReader(std::vector<TextFile> files, RobotId robot);

  /// The next event, valid until the next call; nullptr at the end.
  const Event* next();

  /// The lasers that took the log's scans; a Scan's `laser` is a place in this list. Empty if there is no scan.
  [[nodiscard]] const std::vector<LaserModel>& lasers() const { return lasers_; }
  /// Other models for the lasers. One with a scan_duration has the motion within its scans taken out (see deskew.hpp).
  void set_lasers(std::vector<LaserModel> lasers) { lasers_ = std::move(lasers); }
  [[nodiscard]] const std::vector<Skipped>& skipped() const { return skipped_.all(); }
  /// How much text there is, and how much of it was read so far.
  [[nodiscard]] std::size_t bytes() const;
  [[nodiscard]] std::size_t bytes_done() const;
  /// What a person should know beside the counts.
  [[nodiscard]] const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  void find_lasers();
  bool next_line(std::string_view& line);
  const Event* parse(std::string_view line);
  const Event* parse_front_laser(TextCursor cursor);
  const Event* parse_robot_laser(TextCursor cursor, bool with_pose);
  const Event* parse_odometry(TextCursor cursor);
  const Event* parse_sighting(TextCursor cursor);
  const Event* parse_lookalike(TextCursor cursor);
  static std::string read_name(TextCursor& cursor);
  bool read_ranges(TextCursor& cursor, std::size_t count);
  const Event* finish_scan(const BeamLayout& layout, double stamp);
  void remove_motion(Scan& scan, double stamp);
  const Event* skip(const char* reason, std::string_view what);
  std::string place() const;

  std::vector<TextFile> files_;
  std::size_t file_ = 0;
  std::size_t at_ = 0;
  std::size_t line_number_ = 0;
  std::vector<BeamLayout> layouts_;
  std::vector<LaserModel> lasers_;
  SkipCounter skipped_;
  std::vector<std::string> warnings_;
  Event scan_event_;
  Event other_event_;
  Pose2 T_odom_robot_;  ///< of the last ODOM
  bool has_odometry_ = false;
  Pose2 T_odom_scan_;  ///< the robot at the last scan, for the motion within a sweep
  double scan_stamp_ = 0;
};

/// The layout that a laser message states, without reading its ranges; beams = 0 if it states none.
struct LaserHeader {
  BeamLayout layout;
  TextCursor ranges;  ///< stands before the first range
};
[[nodiscard]] LaserHeader read_front_laser_header(TextCursor cursor);
[[nodiscard]] LaserHeader read_robot_laser_header(TextCursor cursor);

}  // namespace helicoid
