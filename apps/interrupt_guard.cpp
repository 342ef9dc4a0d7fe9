#include "apps/interrupt_guard.hpp"

#include <csignal>

namespace helicoid {

namespace {

volatile std::sig_atomic_t interrupts = 0;
void interrupt(int) {
  interrupts = 1;
}

}  // namespace

InterruptGuard::InterruptGuard() : previous_(std::signal(SIGINT, interrupt)) {
  interrupts = 0;
}

InterruptGuard::~InterruptGuard() {
  std::signal(SIGINT, previous_);
}

bool InterruptGuard::interrupted() {
  return interrupts != 0;
}

}  // namespace helicoid
