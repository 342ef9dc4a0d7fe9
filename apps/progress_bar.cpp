#include "apps/progress_bar.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

namespace helicoid {

ProgressBar::ProgressBar() : on_terminal_(isatty(STDERR_FILENO) != 0) {}

ProgressBar::~ProgressBar() {
  if (shown_) fmt::print(stderr, "\r\033[K");
}

void ProgressBar::show(double share, const char* what) {
  constexpr int kWidth = 40;
  const int percent = static_cast<int>(100 * share);
  if (!on_terminal_ || percent == last_) return;
  last_ = percent;
  shown_ = true;
  const auto filled = static_cast<std::size_t>(kWidth * share);
  fmt::print(stderr, "\r{} [{}{}] {:3d} %", what, std::string(filled, '='), std::string(kWidth - filled, ' '), percent);
  std::fflush(stderr);
}

void ProgressBar::say(const std::string& what) {
  const auto now = std::chrono::steady_clock::now();
  if (!on_terminal_ || (shown_ && now - said_ < std::chrono::milliseconds(100))) return;
  said_ = now;
  shown_ = true;
  fmt::print(stderr, "\r\033[K{}", what);
  std::fflush(stderr);
}

}  // namespace helicoid
