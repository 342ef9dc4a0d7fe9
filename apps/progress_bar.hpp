// A progress bar on a terminal; silence elsewhere.
#pragma once

#include <chrono>
#include <string>

namespace helicoid {

class ProgressBar {
 public:
  ProgressBar();
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;
  /// `share` of the work that is done, 0..1.
  void show(double share, const char* what);
  /// Of work that nobody knows the length of: what is being done, ten times a second at most.
  void say(const std::string& what);

 private:
  bool on_terminal_;
  bool shown_ = false;
  int last_ = -1;
  std::chrono::steady_clock::time_point said_;
};

}  // namespace helicoid
