#include "apps/ceres_judge.hpp"

#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <filesystem>

#include "helicoid/base/whole_file.hpp"

namespace helicoid {

namespace fs = std::filesystem;

namespace {

constexpr const char* kCeres = "ceres_judge";

/// Two files that nobody else uses, gone when this is.
class Exchange {
 public:
  Exchange() {
    static std::atomic<int> count = 0;
    const std::string name = fmt::format("helicoid_judged_{}_{}", getpid(), count++);
    asked = (fs::temp_directory_path() / (name + ".g2o")).string();
    answered = (fs::temp_directory_path() / (name + "_fitted.g2o")).string();
  }
  ~Exchange() {
    std::error_code error;
    fs::remove(asked, error);
    fs::remove(answered, error);
  }
  Exchange(const Exchange&) = delete;
  Exchange& operator=(const Exchange&) = delete;

  std::string asked, answered;
};

}  // namespace

std::string judge_beside(const std::string& program, const std::string& judge) {
  return (fs::path(program).parent_path().parent_path() / "bench" / judge).string();
}

std::string missing_judge(const std::string& program) {
  return fs::exists(judge_beside(program, kCeres)) ? ""
                                                   : "Ceres was not there when this was built (Debian: libceres-dev)";
}

Result<Judged> judge(const GraphFile& file, const std::string& program) {
  const Exchange exchange;
  if (auto done = write_whole_file(exchange.asked, to_graph_text(file, file.graph.poses)); !done)
    return tl::unexpected(done.error());
  const std::string command =
      fmt::format("'{}' '{}' '{}'", judge_beside(program, kCeres), exchange.asked, exchange.answered);
  FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return fail("the judge could not be started");
  Judged judged;
  const int read = std::fscanf(pipe, "%lf %lf %d", &judged.cost, &judged.cpu_s, &judged.iterations);
  if (pclose(pipe) != 0 || read != 3) return fail("the judge failed on {}", exchange.asked);
  Result<GraphFile> fitted = read_graph(exchange.answered);
  if (!fitted) return tl::unexpected(fitted.error());
  judged.poses = std::move(fitted->graph.poses);
  return judged;
}

std::string this_program() {
  std::error_code error;
  return fs::read_symlink("/proc/self/exe", error).string();
}

}  // namespace helicoid
