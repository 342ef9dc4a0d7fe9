// The program as a user runs it: arguments in; exit code, stdout and stderr out.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace helicoid::program {

namespace fs = std::filesystem;

struct Ended {
  int exit_code = -1;  ///< 128 + signal, if a signal ended it
  std::string out;
  std::string err;
};

/// A run of the program that is under way; its input is `input` (a file), or nothing.
class ProgramRun {
 public:
  explicit ProgramRun(const std::vector<std::string>& arguments, const std::string& input = "/dev/null");
  ProgramRun(const ProgramRun&) = delete;
  ProgramRun& operator=(const ProgramRun&) = delete;
  ~ProgramRun();
  /// As Ctrl-C does.
  void interrupt() const;
  [[nodiscard]] Ended wait();

 private:
  pid_t pid_ = -1;
  fs::path out_, err_;
};

[[nodiscard]] inline Ended run(const std::vector<std::string>& arguments, const std::string& input = "/dev/null") {
  return ProgramRun(arguments, input).wait();
}

/// A fresh folder for the running test, gone when the test is over.
class Sandbox {
 public:
  Sandbox();
  Sandbox(const Sandbox&) = delete;
  Sandbox& operator=(const Sandbox&) = delete;
  ~Sandbox();
  [[nodiscard]] std::string operator/(const std::string& name) const { return (folder_ / name).string(); }
  /// Writes a file and returns its path.
  std::string write(const std::string& name, const std::string& bytes) const;
  /// Simulates robots in the world `room` below `name`; returns that folder. Logs: robot1.clf.gz and so on.
  std::string simulate(const std::string& name, const std::vector<std::string>& options = {}) const;

 private:
  fs::path folder_;
};

[[nodiscard]] std::string bytes_of(const fs::path& path);

/// What a folder holds, sorted, relative to it: files only.
[[nodiscard]] std::vector<std::string> files_in(const fs::path& folder);

}  // namespace helicoid::program
