#include "helicoid/io/carmen_reader.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>

#include "helicoid/sensor/deskew.hpp"

namespace helicoid {

namespace {

constexpr std::size_t kMostBeams = 20000;
/// Scans whose ranges are looked at to recognise the laser.
constexpr std::size_t kSampleScans = 500;

bool starts_with(std::string_view line, std::string_view word) {
  return line.size() > word.size() && line.starts_with(word) && line[word.size()] == ' ';
}

TextCursor after(std::string_view line, std::string_view word) {
  return {line.data() + word.size(), line.data() + line.size()};
}

Pose2 read_pose(TextCursor& cursor, bool& ok) {
  const ReadNumber x = read_number(cursor);
  const ReadNumber y = read_number(cursor);
  const ReadNumber yaw = read_number(cursor);
  ok = ok && x.ok && y.ok && yaw.ok && std::isfinite(x.value) && std::isfinite(y.value) && std::isfinite(yaw.value);
  return ok ? Pose2{x.value, y.value, wrap_angle(yaw.value)} : Pose2{};
}

}  // namespace

LaserHeader read_front_laser_header(TextCursor cursor) {
  const ReadNumber count = read_number(cursor);
  if (!count.ok || !(count.value >= 1 && count.value <= kMostBeams)) return {};
  return {front_laser_layout(static_cast<int>(count.value)), cursor};
}

LaserHeader read_robot_laser_header(TextCursor cursor) {
  double head[8] = {};  // type, start, field of view, resolution, largest range, accuracy, remission mode, beams
  for (double& value : head) {
    const ReadNumber number = read_number(cursor);
    if (!number.ok || !std::isfinite(number.value)) return {};
    value = number.value;
  }
  if (!(head[7] >= 1 && head[7] <= kMostBeams) || !(head[3] > 0)) return {};
  return {{static_cast<int>(head[7]), head[1], head[3]}, cursor};
}

CarmenReader::CarmenReader(std::vector<TextFile> files, RobotId robot) : files_(std::move(files)) {
  scan_event_.robot = other_event_.robot = robot;
  scan_event_.body = Scan{};
  for (const TextFile& file : files_) {
    if (!file.warning.empty()) warnings_.push_back(file.warning);
  }
  find_lasers();
}

void CarmenReader::find_lasers() {
  std::vector<std::vector<float>> samples;
  std::vector<std::size_t> scans;
  std::string_view line;
  while (next_line(line)) {
    LaserHeader header;
    if (starts_with(line, "FLASER")) {
      header = read_front_laser_header(after(line, "FLASER"));
    } else if (starts_with(line, "ROBOTLASER1")) {
      header = read_robot_laser_header(after(line, "ROBOTLASER1"));
    } else if (starts_with(line, "RAWLASER1")) {
      header = read_robot_laser_header(after(line, "RAWLASER1"));
    }
    if (header.layout.beams == 0) continue;
    const auto known = std::find(layouts_.begin(), layouts_.end(), header.layout);
    const auto index = static_cast<std::size_t>(known - layouts_.begin());
    if (known == layouts_.end()) {
      layouts_.push_back(header.layout);
      samples.emplace_back();
      scans.push_back(0);
    }
    if (scans[index]++ >= kSampleScans) continue;
    for (int i = 0; i < header.layout.beams; ++i) {
      const ReadNumber range = read_number(header.ranges);
      if (!range.ok) break;
      samples[index].push_back(static_cast<float>(range.value));
    }
  }
  for (std::size_t i = 0; i < layouts_.size(); ++i) lasers_.push_back(recognise_laser(layouts_[i], samples[i]));
  file_ = at_ = line_number_ = 0;
}

bool CarmenReader::next_line(std::string_view& line) {
  while (file_ < files_.size() && at_ >= files_[file_].text.size()) {
    ++file_;
    at_ = line_number_ = 0;
  }
  if (file_ == files_.size()) return false;
  const std::string& text = files_[file_].text;
  const void* newline = std::memchr(text.data() + at_, '\n', text.size() - at_);
  const std::size_t end =
      newline != nullptr ? static_cast<std::size_t>(static_cast<const char*>(newline) - text.data()) : text.size();
  line = {text.data() + at_, end - at_};
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  at_ = end + 1;
  ++line_number_;
  return true;
}

std::size_t CarmenReader::bytes() const {
  std::size_t sum = 0;
  for (const TextFile& file : files_) sum += file.text.size();
  return sum;
}

std::size_t CarmenReader::bytes_done() const {
  std::size_t sum = at_;
  for (std::size_t i = 0; i < file_; ++i) sum += files_[i].text.size();
  return sum;
}

const Event* CarmenReader::next() {
  std::string_view line;
  while (next_line(line)) {
    if (const Event* event = parse(line)) return event;
  }
  return nullptr;
}

const Event* CarmenReader::parse(std::string_view line) {
  if (line.empty() || line[0] == '#') return nullptr;
  if (starts_with(line, "FLASER")) return parse_front_laser(after(line, "FLASER"));
  if (starts_with(line, "ODOM")) return parse_odometry(after(line, "ODOM"));
  if (starts_with(line, "ROBOTLASER1")) return parse_robot_laser(after(line, "ROBOTLASER1"), true);
  if (starts_with(line, "RAWLASER1")) return parse_robot_laser(after(line, "RAWLASER1"), false);
  if (starts_with(line, "SIGHTING")) return parse_sighting(after(line, "SIGHTING"));
  if (starts_with(line, "LOOKALIKE")) return parse_lookalike(after(line, "LOOKALIKE"));
  if (starts_with(line, "PARAM") || starts_with(line, "SYNC")) return nullptr;
  return skip("message of a kind that is not mapped", line.substr(0, std::min<std::size_t>(line.find(' '), 24)));
}

bool CarmenReader::read_ranges(TextCursor& cursor, std::size_t count) {
  auto& ranges = std::get<Scan>(scan_event_.body).ranges;
  ranges.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const ReadNumber range = read_number(cursor);
    if (!range.ok) return false;
    ranges[i] = static_cast<float>(range.value);
  }
  return true;
}

const Event* CarmenReader::finish_scan(const BeamLayout& layout, double stamp) {
  Scan& scan = std::get<Scan>(scan_event_.body);
  scan.laser = static_cast<int>(std::find(layouts_.begin(), layouts_.end(), layout) - layouts_.begin());
  scan_event_.stamp = stamp;
  const bool odd = std::any_of(scan.ranges.begin(), scan.ranges.end(), [](float r) { return !(r >= 0) || r > 1e6F; });
  // The scan stays: such beams are no returns.
  if (odd) skip("scan with ranges that are NaN, infinite or negative; those beams are ignored", "laser message");
  if (lasers_[static_cast<std::size_t>(scan.laser)].scan_duration > 0) remove_motion(scan, stamp);
  return &scan_event_;
}

void CarmenReader::remove_motion(Scan& scan, double stamp) {
  // Stamps jitter and step back, odometry jumps: what no robot does gives no speed.
  constexpr double kLongest = 1;   // seconds between scans
  constexpr double kFastest = 4;   // metres / second
  constexpr double kQuickest = 5;  // radians / second
  const double elapsed = stamp - scan_stamp_;
  const Vector3d twist = logarithm(T_odom_scan_.inverse() * scan.T_odom_robot) / elapsed;
  if (scan.has_odometry && elapsed > 0 && elapsed <= kLongest && twist.head<2>().norm() <= kFastest &&
      std::abs(twist[2]) <= kQuickest) {
    scan = deskew(scan, lasers_[static_cast<std::size_t>(scan.laser)], twist);
  } else {
    skip("scan without a believable speed; the motion within it is left in", "laser message");
  }
  T_odom_scan_ = scan.T_odom_robot;
  scan_stamp_ = stamp;
}

const Event* CarmenReader::parse_front_laser(TextCursor cursor) {
  const LaserHeader header = read_front_laser_header(cursor);
  if (header.layout.beams == 0) return skip("laser message without a believable number of beams", "FLASER");
  cursor = header.ranges;
  if (!read_ranges(cursor, static_cast<std::size_t>(header.layout.beams))) {
    return skip("laser message with fewer ranges than beams, or with words among them", "FLASER");
  }
  bool ok = true;
  const Pose2 T_odom_laser = read_pose(cursor, ok);
  Scan& scan = std::get<Scan>(scan_event_.body);
  const Pose2 T_odom_robot = read_pose(cursor, ok);
  const ReadNumber stamp = read_number(cursor);
  if (!ok || !stamp.ok || !std::isfinite(stamp.value)) {
    return skip("laser message whose numbers do not match its beams", "FLASER");
  }
  scan.T_odom_robot = T_odom_robot;
  scan.has_odometry = true;
  const Pose2 T_robot_laser = T_odom_robot.inverse() * T_odom_laser;
  // The log's six decimals jitter; the laser does not.
  const Pose2 change = scan.T_robot_laser.inverse() * T_robot_laser;
  if (change.distance() > 1e-4 || std::abs(change.yaw) > 1e-4) scan.T_robot_laser = T_robot_laser;
  return finish_scan(header.layout, stamp.value);
}

const Event* CarmenReader::parse_robot_laser(TextCursor cursor, bool with_pose) {
  const LaserHeader header = read_robot_laser_header(cursor);
  if (header.layout.beams == 0) return skip("laser message without a believable number of beams", "LASER1");
  cursor = header.ranges;
  bool ok = read_ranges(cursor, static_cast<std::size_t>(header.layout.beams));
  const ReadNumber remissions = read_number(cursor);
  ok = ok && remissions.ok && remissions.value >= 0 && remissions.value <= kMostBeams;
  for (int i = 0; ok && i < static_cast<int>(remissions.value); ++i) ok = read_number(cursor).ok;
  Scan& scan = std::get<Scan>(scan_event_.body);
  if (with_pose) {
    const Pose2 T_odom_laser = read_pose(cursor, ok);
    scan.T_odom_robot = read_pose(cursor, ok);
    scan.T_robot_laser = scan.T_odom_robot.inverse() * T_odom_laser;
    if (scan.T_robot_laser.distance() < 1e-5 && std::abs(scan.T_robot_laser.yaw) < 1e-5) scan.T_robot_laser = {};
    scan.has_odometry = true;
    for (int i = 0; ok && i < 5; ++i) ok = read_number(cursor).ok;  // tv rv forward side turn
  } else {
    scan.T_odom_robot = T_odom_robot_;
    scan.T_robot_laser = {};
    scan.has_odometry = has_odometry_;
  }
  const ReadNumber stamp = read_number(cursor);
  if (!ok || !stamp.ok || !std::isfinite(stamp.value)) {
    return skip("laser message whose numbers do not match its beams", "LASER1");
  }
  return finish_scan(header.layout, stamp.value);
}

const Event* CarmenReader::parse_odometry(TextCursor cursor) {
  bool ok = true;
  const Pose2 T_odom_robot = read_pose(cursor, ok);
  for (int i = 0; ok && i < 3; ++i) ok = read_number(cursor).ok;  // tv rv accel
  const ReadNumber stamp = read_number(cursor);
  if (!ok || !stamp.ok || !std::isfinite(stamp.value)) return skip("odometry message with wrong numbers", "ODOM");
  T_odom_robot_ = T_odom_robot;
  has_odometry_ = true;
  other_event_.stamp = stamp.value;
  other_event_.body = Odometry{T_odom_robot};
  return &other_event_;
}

const Event* CarmenReader::skip(const char* reason, std::string_view what) {
  skipped_.add(reason, [&] { return fmt::format("{}: {}", place(), what); });
  return nullptr;
}

std::string CarmenReader::place() const {
  return fmt::format("{}:{}", files_[file_].name, line_number_);
}

}  // namespace helicoid
