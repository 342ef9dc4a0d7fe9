#include "helicoid/io/mrclam_reader.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <set>

#include "helicoid/io/number.hpp"
#include "helicoid/io/text_file.hpp"

namespace helicoid {

namespace fs = std::filesystem;

namespace {

/// The collection numbers its subjects so: robots first.
constexpr std::uint32_t kMostRobots = 5;

/// The file of this name, plain or gzipped.
std::optional<std::string> find_file(const std::string& folder, const std::string& name) {
  std::error_code error;
  for (const char* ending : {"", ".gz"}) {
    const std::string path = fmt::format("{}/{}{}", folder, name, ending);
    if (fs::is_regular_file(path, error)) return path;
  }
  return std::nullopt;
}

std::string file_of(std::uint32_t robot, const char* kind) {
  return fmt::format("Robot{}_{}.dat", robot, kind);
}

std::optional<std::uint32_t> whole_number(double value) {
  if (value < 0 || value > 1e6 || value != std::floor(value)) return std::nullopt;
  return static_cast<std::uint32_t>(value);
}

std::vector<Skipped> merged(std::vector<Skipped> all, const std::vector<Skipped>& more) {
  for (const Skipped& s : more) {
    const auto same = std::find_if(all.begin(), all.end(), [&](const Skipped& t) { return t.reason == s.reason; });
    if (same == all.end()) {
      all.push_back(s);
    } else {
      same->count += s.count;
    }
  }
  return all;
}

/// Reads the files of a folder one after another, and keeps what they have to say.
class FolderReader {
 public:
  explicit FolderReader(std::string folder) : folder_(std::move(folder)) {}

  Result<MrclamFolder> read() {
    const std::vector<std::uint32_t> robots = list_robots();
    if (robots.empty())
      return fail("{}: holds no Robot1_Odometry.dat; an MRCLAM folder has one for each robot", folder_);
    if (auto done = read_barcodes(robots); !done) return tl::unexpected(done.error());
    for (const std::uint32_t robot : robots) {
      if (auto done = read_robot(robot); !done) return tl::unexpected(done.error());
    }
    if (auto done = read_landmark_truth(); !done) return tl::unexpected(done.error());
    result_.skipped = merged(std::move(result_.skipped), skipped_.all());
    return std::move(result_);
  }

 private:
  [[nodiscard]] std::vector<std::uint32_t> list_robots() const {
    std::vector<std::uint32_t> robots;
    for (std::uint32_t i = 1; i <= kMostRobots; ++i) {
      if (find_file(folder_, file_of(i, "Odometry"))) robots.push_back(i);
    }
    return robots;
  }

  /// A file's rows; an empty table if it is not there.
  Result<MrclamTable> table(const std::string& file, std::size_t columns) {
    const std::optional<std::string> path = find_file(folder_, file);
    if (!path) return MrclamTable{};
    Result<TextFile> text = read_text_file(*path);
    if (!text) return tl::unexpected(text.error());
    if (!text->warning.empty()) result_.warnings.push_back(text->warning);
    MrclamTable table = parse_mrclam(text->text, columns, *path);
    result_.skipped = merged(std::move(result_.skipped), table.skipped);
    return table;
  }

  /// The same of a file without which there is nothing to do.
  Result<MrclamTable> needed_table(const std::string& file, std::size_t columns, const char* what) {
    Result<MrclamTable> found = table(file, columns);
    if (found && found->rows.empty()) {
      return fail("{}/{}: holds no {}; put the file of the MRCLAM collection there, plain or gzipped", folder_, file,
                  what);
    }
    return found;
  }

  Result<void> read_barcodes(const std::vector<std::uint32_t>& robots) {
    const Result<MrclamTable> rows = needed_table("Barcodes.dat", 2, "line `subject barcode`");
    if (!rows) return tl::unexpected(rows.error());
    std::map<std::uint32_t, std::uint32_t> barcodes;  // by subject
    for (const MrclamRow& row : rows->rows) {
      const auto subject = whole_number(row.values[0]);
      const auto barcode = whole_number(row.values[1]);
      if (!subject || !barcode || !barcodes.emplace(*subject, *barcode).second) skip("Barcodes.dat", row, kNoBarcode);
    }
    for (const std::uint32_t robot : robots) place_[robot] = static_cast<std::uint32_t>(place_.size());
    for (const auto& [subject, barcode] : barcodes) {
      if (subject > kMostRobots) {
        place_[subject] = static_cast<std::uint32_t>(place_.size());
        result_.log.landmarks.push_back(fmt::format("landmark{}", subject));
      }
      subject_of_[barcode] = subject;
    }
    return {};
  }

  Result<void> read_robot(std::uint32_t number) {
    TeamRobot robot;
    robot.name = fmt::format("robot{}", number);
    const std::string odometry = file_of(number, "Odometry");
    const Result<MrclamTable> moves = needed_table(odometry, 3, "line `time forward_velocity angular_velocity`");
    if (!moves) return tl::unexpected(moves.error());
    double latest = -HUGE_VAL;
    for (const MrclamRow& row : moves->rows) {
      if (!is_in_order(odometry, row, latest)) continue;
      robot.velocities.push_back({row.values[0], row.values[1], row.values[2]});
    }
    const std::string measurement = file_of(number, "Measurement");
    const Result<MrclamTable> seen = needed_table(measurement, 4, "line `time barcode range bearing`");
    if (!seen) return tl::unexpected(seen.error());
    latest = -HUGE_VAL;
    for (const MrclamRow& row : seen->rows) add_detection(robot, number, measurement, row, latest);
    result_.log.robots.push_back(std::move(robot));
    return read_truth(number);
  }

  void add_detection(TeamRobot& robot, std::uint32_t number, const std::string& file, const MrclamRow& row,
                     double& latest) {
    const auto barcode = whole_number(row.values[1]);
    const auto subject = barcode ? subject_of_.find(*barcode) : subject_of_.end();
    if (subject == subject_of_.end()) return skip(file, row, "detection of a barcode that Barcodes.dat does not name");
    if (subject->second == number) return skip(file, row, "detection of the robot itself");
    const auto place = place_.find(subject->second);
    if (place == place_.end()) return skip(file, row, "detection of a robot that has no log here");
    if (!(row.values[2] > 0)) return skip(file, row, "detection without a positive range");
    if (!is_in_order(file, row, latest)) return;
    robot.detections.push_back({row.values[0], place->second, row.values[2], wrap_angle(row.values[3])});
  }

  /// Time that steps back cannot be told from a damaged stamp.
  bool is_in_order(const std::string& file, const MrclamRow& row, double& latest) {
    if (row.values[0] < latest) {
      skip(file, row, "line whose stamp is before that of a line above it");
      return false;
    }
    latest = row.values[0];
    return true;
  }

  Result<void> read_truth(std::uint32_t number) {
    const std::string file = file_of(number, "Groundtruth");
    const Result<MrclamTable> rows = table(file, 4);
    if (!rows) return tl::unexpected(rows.error());
    std::vector<StampedPose>& truth = result_.truth.emplace_back();
    double latest = -HUGE_VAL;
    for (const MrclamRow& row : rows->rows) {
      if (!is_in_order(file, row, latest)) continue;
      truth.push_back({row.values[0], {row.values[1], row.values[2], wrap_angle(row.values[3])}});
    }
    return {};
  }

  Result<void> read_landmark_truth() {
    const std::string file = "Landmark_Groundtruth.dat";
    const Result<MrclamTable> rows = table(file, 5);
    if (!rows) return tl::unexpected(rows.error());
    for (const MrclamRow& row : rows->rows) {
      const auto subject = whole_number(row.values[0]);
      if (!subject || !place_.contains(*subject) || *subject <= kMostRobots) {
        skip(file, row, "true position of no landmark of Barcodes.dat");
      } else {
        result_.landmarks[fmt::format("landmark{}", *subject)] = {row.values[1], row.values[2]};
      }
    }
    return {};
  }

  void skip(const std::string& file, const MrclamRow& row, const char* reason) {
    skipped_.add(reason, [&] { return fmt::format("{}/{}:{}", folder_, file, row.line); });
  }

  static constexpr const char* kNoBarcode = "barcode or subject that is no whole number, or a subject named twice";

  std::string folder_;
  MrclamFolder result_;
  SkipCounter skipped_;
  std::map<std::uint32_t, std::uint32_t> place_;       ///< in the log, by subject
  std::map<std::uint32_t, std::uint32_t> subject_of_;  ///< by barcode
};

/// The line's numbers, if there are exactly so many and no more; empty otherwise.
std::vector<double> numbers_of(std::string_view line, std::size_t columns) {
  TextCursor cursor{line.data(), line.data() + line.size()};
  std::vector<double> values(columns);
  for (double& value : values) {
    const ReadNumber number = read_number(cursor);
    if (!number.ok || !std::isfinite(number.value)) return {};
    value = number.value;
  }
  cursor.skip_blanks();
  return cursor.at == cursor.end ? values : std::vector<double>{};
}

}  // namespace

MrclamTable parse_mrclam(std::string_view text, std::size_t columns, const std::string& name) {
  MrclamTable table;
  SkipCounter skipped;
  std::size_t line_number = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    ++line_number;
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = text.substr(begin, end - begin);
    begin = end + 1;
    const std::size_t first = line.find_first_not_of(" \t\r");
    if (first == std::string_view::npos || line[first] == '#') continue;
    std::vector<double> values = numbers_of(line, columns);
    if (values.empty()) {
      skipped.add("line without the numbers that its file has",
                  [&] { return fmt::format("{}:{}: {} numbers are expected", name, line_number, columns); });
    } else {
      table.rows.push_back({line_number, std::move(values)});
    }
  }
  table.skipped = skipped.all();
  return table;
}

bool is_mrclam_folder(const std::string& folder) {
  std::error_code error;
  if (!fs::is_directory(folder, error) || !find_file(folder, "Barcodes.dat")) return false;
  for (std::uint32_t i = 1; i <= kMostRobots; ++i) {
    if (find_file(folder, file_of(i, "Odometry"))) return true;
  }
  return false;
}

Result<MrclamFolder> read_mrclam(const std::string& folder) {
  return FolderReader(folder).read();
}

}  // namespace helicoid
