#include "apps/map_run.hpp"

#include <algorithm>
#include <ctime>

#include "apps/interrupt_guard.hpp"
#include "helicoid/io/laser_file.hpp"

namespace helicoid {

namespace {

/// Which of a robot's scans a job asks for.
class Selection {
 public:
  Selection(const MapJob& job, std::size_t robots) : job_(job), first_(robots, 0), seen_(robots, 0) {}
  bool wants(const Event& event) {
    const std::size_t robot = event.robot.index();
    if (!std::holds_alternative<Scan>(event.body)) return true;
    if (seen_[robot] == 0) first_[robot] = event.stamp;
    const std::size_t index = seen_[robot]++;
    const double since = event.stamp - first_[robot];
    return index % job_.every == 0 && since >= job_.from && since <= job_.to;
  }

 private:
  const MapJob& job_;
  std::vector<double> first_;
  std::vector<std::size_t> seen_;
};

void collect_skipped(MapRun& run, MergedLogs& logs) {
  for (const auto& robot : logs.robots()) {
    for (const Skipped& s : robot.reader->skipped()) run.skipped.push_back(s);
    for (const std::string& w : robot.reader->warnings()) run.warnings.push_back(w);
  }
  for (Skipped& s : skipped_by(run.mapper)) run.skipped.push_back(std::move(s));
}

/// Makes the logs' robots and their lasers known to the mapper.
Result<void> add_robots(const MapJob& job, MergedLogs& logs, MapRun& run) {
  for (auto& robot : logs.robots()) {
    std::vector<LaserModel> lasers = robot.reader->lasers();
    for (LaserModel& laser : lasers) {
      if (!job.laser.empty()) {
        Result<LaserModel> named = load_laser(job.laser, laser);
        if (!named) return tl::unexpected(named.error());
        laser = *named;
      }
      for (double* noise : {&laser.range_sigma, &laser.incidence_bias, &laser.floor_position, &laser.floor_heading}) {
        *noise *= job.laser_noise;
      }
      run.lasers.push_back(fmt::format("{}: {}", robot.logs.name, describe(laser)));
    }
    robot.reader->set_lasers(lasers);
    run.mapper.add_robot(robot.logs.name, lasers);
    run.logs.push_back(fmt::format("{}", fmt::join(robot.logs.paths, ",")));
  }
  return {};
}

double share_done(MergedLogs& logs) {
  std::size_t bytes = 0;
  std::size_t done = 0;
  for (const auto& robot : logs.robots()) {
    bytes += robot.reader->bytes();
    done += robot.reader->bytes_done();
  }
  return static_cast<double>(done) / static_cast<double>(std::max<std::size_t>(bytes, 1));
}

/// The next event, and what reading costs: a thread's clock is a call to the system, so one event in a few is timed.
class TimedLogs {
 public:
  explicit TimedLogs(MergedLogs& logs) : logs_(logs) {}
  const Event* next() {
    if (count_++ % kEvery != 0) return logs_.next();
    const double before = thread_cpu_seconds();
    const Event* event = logs_.next();
    seconds_ += kEvery * (thread_cpu_seconds() - before);
    return event;
  }
  [[nodiscard]] double seconds() const { return seconds_; }

 private:
  static constexpr std::size_t kEvery = 17;
  MergedLogs& logs_;
  std::size_t count_ = 0;
  double seconds_ = 0;
};

/// Returns what reading took, in seconds.
double map_events(const MapJob& job, MergedLogs& logs, MapRun& run) {
  Selection selection(job, logs.robots().size());
  TimedLogs timed(logs);
  double before = thread_cpu_seconds();
  while (const Event* event = timed.next()) {
    // One scan at least, so that there is a map to write.
    if (InterruptGuard::interrupted() && !run.scan_seconds.empty()) break;
    if (!selection.wants(*event)) continue;
    if (!job.sightings && std::holds_alternative<Sighting>(event->body)) continue;
    run.mapper.process(*event);
    if (!std::holds_alternative<Scan>(event->body)) continue;
    const double now = thread_cpu_seconds();
    run.scan_seconds.push_back(now - before);
    before = now;
    if (job.progress && run.scan_seconds.size() % 256 == 0) job.progress(share_done(logs));
  }
  run.scans = run.scan_seconds.size();
  run.interrupted = InterruptGuard::interrupted();
  return timed.seconds();
}

}  // namespace

std::vector<Skipped> skipped_by(const Mapper& mapper) {
  std::vector<Skipped> skipped;
  const MapperCounts& counts = mapper.counts();
  const auto add = [&](const char* reason, std::size_t count) {
    if (count > 0) skipped.push_back({reason, count, ""});
  };
  add("impossible odometry step; constant velocity used instead", counts.odometry_jumps);
  add("scan without a return; placed by odometry", counts.empty_scans);
  add("scan that matched nothing; placed by odometry", counts.predicted - counts.empty_scans);
  add("scan without odometry; constant velocity used instead", counts.scans_without_odometry);
  add("sighting of an unknown robot, kept as unidentified", counts.unidentified_sightings);
  add("sighting of a robot that was nowhere at that time", counts.sightings_without_place);
  add("look-alike with a robot that is unknown or was nowhere at that time", counts.lookalikes_of_nobody);
  const Ledger& ledger = mapper.ledger();
  add("sighting that is still open: see the ledger",
      static_cast<std::size_t>(std::count_if(ledger.begin(), ledger.end(), [](const Hypothesis& h) {
        return h.source == HypothesisSource::sighting && h.state == HypothesisState::open;
      })));
  add("return of a robot that was seen; left out of the scan", counts.returns_of_robots);
  add("sighting of the robot itself", counts.self_sightings);
  return skipped;
}

double thread_cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

namespace {

/// One pass over the logs, under these decisions.
Result<void> pass_over(const MapJob& job, const std::vector<Decision>& decisions, MapRun& run) {
  const double start = thread_cpu_seconds();
  Result<MergedLogs> logs = MergedLogs::open(job.robots);
  if (!logs) return tl::unexpected(logs.error());
  MapperOptions options = job.mapper;
  options.decisions = decisions;
  run.mapper = Mapper(options);
  run.scan_seconds.clear();
  run.lasers.clear();
  run.logs.clear();
  if (auto added = add_robots(job, *logs, run); !added) return added;
  const double opened = thread_cpu_seconds();
  const double reading = map_events(job, *logs, run);
  run.phase.read += opened - start + reading;
  run.phase.match += thread_cpu_seconds() - opened - reading - run.mapper.times().close_s;
  run.mapper.finish();
  run.phase.fit += run.mapper.times().fit_s;
  run.phase.close += run.mapper.times().close_s;
  if (run.scans == 0) return fail("no scan was mapped: the logs hold none in the range that was asked for");
  run.skipped.clear();
  run.warnings.clear();
  collect_skipped(run, *logs);
  return {};
}

bool reads_stdin(const MapJob& job) {
  return std::any_of(job.robots.begin(), job.robots.end(), [](const RobotLogs& r) {
    return std::find(r.paths.begin(), r.paths.end(), "-") != r.paths.end();
  });
}

}  // namespace

Result<MapRun> run_map(const MapJob& job) {
  const InterruptGuard guard;
  MapRun run;
  std::vector<Decision> decisions = job.mapper.decisions;
  for (;;) {
    if (auto done = pass_over(job, decisions, run); !done) return tl::unexpected(done.error());
    ++run.passes;
    // What was believed at once and what the finished map contradicts is undone: by a pass that never believed it.
    std::vector<Decision> regrets = run.mapper.regrets(run.passes);
    if (regrets.empty() || run.interrupted) break;
    if (reads_stdin(job)) {
      run.warnings.push_back(
          fmt::format("{} sightings turned out wrong, but stdin cannot be read twice: name a file", regrets.size()));
      break;
    }
    decisions.insert(decisions.end(), std::make_move_iterator(regrets.begin()), std::make_move_iterator(regrets.end()));
  }
  return run;
}

}  // namespace helicoid
