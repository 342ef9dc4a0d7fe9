// Ctrl-C as a wish, not an end.
#pragma once

namespace helicoid {

/// As long as one lives, Ctrl-C only sets `interrupted`.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;
  [[nodiscard]] static bool interrupted();

 private:
  void (*previous_)(int);
};

}  // namespace helicoid
