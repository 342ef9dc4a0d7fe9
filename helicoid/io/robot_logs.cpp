#include "helicoid/io/robot_logs.hpp"

#include <algorithm>
#include <limits>

namespace helicoid {

namespace {

bool is_name(const std::string& name) {
  return !name.empty() && name.size() <= 64 && std::all_of(name.begin(), name.end(), [](unsigned char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
}

std::string base_name(std::string path) {
  if (path == "-") return "stdin";
  while (path.size() > 1 && path.back() == '/') path.pop_back();
  const std::string file = path.substr(path.find_last_of('/') + 1);
  return file.substr(0, file.find('.'));
}

Result<std::vector<TextFile>> read_all(const RobotLogs& logs) {
  std::vector<TextFile> files;
  for (const std::string& path : logs.paths) {
    Result<TextFile> file = read_text_file(path);
    if (!file) return tl::unexpected(file.error());
    if (looks_binary(file->text)) return fail("{}: is a binary file, not a CARMEN log", file->name);
    files.push_back(std::move(*file));
  }
  return files;
}

}  // namespace

Result<std::vector<RobotLogs>> name_robots(std::span<const std::string> logs, std::span<const std::string> named) {
  std::vector<RobotLogs> robots;
  for (const std::string& path : logs) robots.push_back({base_name(path), {path}});
  for (const std::string& text : named) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos) return fail("--robot {}: write NAME=LOG or NAME=LOG,LOG", text);
    RobotLogs robot{text.substr(0, equals), {}};
    for (std::size_t at = equals + 1; at <= text.size();) {
      const std::size_t comma = std::min(text.find(',', at), text.size());
      if (comma == at) return fail("--robot {}: a log's name is missing", text);
      robot.paths.push_back(text.substr(at, comma - at));
      at = comma + 1;
    }
    robots.push_back(std::move(robot));
  }
  std::sort(robots.begin(), robots.end(), [](const RobotLogs& a, const RobotLogs& b) { return a.name < b.name; });
  for (std::size_t i = 0; i < robots.size(); ++i) {
    if (!is_name(robots[i].name)) {
      return fail(
          "{}: \"{}\" cannot be a robot's name (letters, digits, _ and -, at most 64); give one with "
          "--robot NAME={}",
          robots[i].paths.front(), robots[i].name, robots[i].paths.front());
    }
    if (i > 0 && robots[i].name == robots[i - 1].name) {
      return fail("{} and {} are both robot \"{}\"; tell them apart with --robot NAME=LOG", robots[i - 1].paths.front(),
                  robots[i].paths.front(), robots[i].name);
    }
  }
  return robots;
}

Result<MergedLogs> MergedLogs::open(std::vector<RobotLogs> robots) {
  MergedLogs merged;
  for (std::size_t i = 0; i < robots.size(); ++i) {
    Result<std::vector<TextFile>> files = read_all(robots[i]);
    if (!files) return tl::unexpected(files.error());
    const bool empty = std::all_of(files->begin(), files->end(), [](const TextFile& f) { return f.text.empty(); });
    const std::string first = files->front().name;
    const std::string warning = files->front().warning;
    if (empty) return fail("{}: is empty{}", first, warning.empty() ? "" : " (" + warning + ")");
    auto reader = std::make_unique<CarmenReader>(std::move(*files), make_id<RobotId>(i));
    if (reader->lasers().empty()) {
      return fail("{}: holds no laser scan (FLASER, ROBOTLASER1 or RAWLASER1 lines); is it a CARMEN log?", first);
    }
    merged.robots_.push_back(
        {std::move(robots[i]), std::move(reader), nullptr, -std::numeric_limits<double>::infinity()});
  }
  return merged;
}

void MergedLogs::advance(Robot& robot) {
  robot.head = robot.reader->next();
  if (robot.head != nullptr) robot.latest = std::max(robot.latest, robot.head->stamp);
}

const Event* MergedLogs::next() {
  if (!started_) {
    for (Robot& robot : robots_) advance(robot);
    started_ = true;
  } else if (given_ != nullptr) {
    advance(*given_);
  }
  given_ = nullptr;
  // Robots are sorted by name, so the first of equals is the right one.
  for (Robot& robot : robots_) {
    if (robot.head != nullptr && (given_ == nullptr || robot.latest < given_->latest)) given_ = &robot;
  }
  return given_ != nullptr ? given_->head : nullptr;
}

}  // namespace helicoid
