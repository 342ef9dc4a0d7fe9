// CPU time of the calling thread: what the work costs, however busy the machine is.
#pragma once

#include <ctime>

namespace helicoid {

/// Adds the CPU seconds of its lifetime to a counter.
class CpuTimer {
 public:
  explicit CpuTimer(double& seconds) : seconds_(seconds), began_(now()) {}
  ~CpuTimer() { seconds_ += now() - began_; }
  CpuTimer(const CpuTimer&) = delete;
  CpuTimer& operator=(const CpuTimer&) = delete;

  [[nodiscard]] static double now() {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  }

 private:
  double& seconds_;
  double began_;
};

}  // namespace helicoid
