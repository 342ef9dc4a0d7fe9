// A progress bar on a terminal; silence elsewhere.
#pragma once

namespace helicoid {

class ProgressBar {
 public:
  ProgressBar();
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;
  /// `share` of the work that is done, 0..1.
  void show(double share, const char* what);

 private:
  bool on_terminal_;
  bool shown_ = false;
  int last_ = -1;
};

}  // namespace helicoid
