#include "tests/program.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <fstream>
#include <iterator>

namespace helicoid::program {

namespace {

fs::path fresh_path(const std::string& kind) {
  static std::atomic<int> count = 0;
  return fs::path(testing::TempDir()) / ("helicoid_" + kind + std::to_string(getpid()) + "_" + std::to_string(count++));
}

}  // namespace

ProgramRun::ProgramRun(const std::vector<std::string>& arguments, const std::string& input)
    : out_(fresh_path("out")), err_(fresh_path("err")) {
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, input.c_str(), O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, out_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  posix_spawn_file_actions_addopen(&files, STDERR_FILENO, err_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  std::vector<std::string> words{HELICOID_PROGRAM};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  if (posix_spawn(&pid_, HELICOID_PROGRAM, &files, nullptr, pointers.data(), environ) != 0) pid_ = -1;
  posix_spawn_file_actions_destroy(&files);
}

ProgramRun::~ProgramRun() {
  if (pid_ > 0) {
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  std::error_code error;
  fs::remove(out_, error);
  fs::remove(err_, error);
}

void ProgramRun::interrupt() const {
  if (pid_ > 0) kill(pid_, SIGINT);
}

Ended ProgramRun::wait() {
  if (pid_ <= 0) return {};
  int status = 0;
  waitpid(pid_, &status, 0);
  pid_ = -1;
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return {code, bytes_of(out_), bytes_of(err_)};
}

Sandbox::Sandbox() : folder_(fresh_path("sandbox")) {
  fs::remove_all(folder_);
  fs::create_directories(folder_);
}

Sandbox::~Sandbox() {
  std::error_code error;
  fs::remove_all(folder_, error);
}

std::string Sandbox::write(const std::string& name, const std::string& bytes) const {
  std::ofstream(folder_ / name, std::ios::binary) << bytes;
  return *this / name;
}

std::string Sandbox::simulate(const std::string& name, const std::vector<std::string>& options) const {
  std::vector<std::string> arguments{"simulate", "room", "--out", *this / name};
  arguments.insert(arguments.end(), options.begin(), options.end());
  const Ended ended = run(arguments);
  EXPECT_EQ(ended.exit_code, 0) << ended.err;
  return *this / name;
}

std::string bytes_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

std::vector<std::string> files_in(const fs::path& folder) {
  std::vector<std::string> files;
  std::error_code error;
  for (const auto& entry : fs::recursive_directory_iterator(folder, error)) {
    if (entry.is_regular_file()) files.push_back(fs::relative(entry.path(), folder).generic_string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace helicoid::program
