#include "apps/verb.hpp"

#include <fmt/format.h>

#include <cstdio>

namespace helicoid {

int report_failure(const std::string& message) {
  fmt::print(stderr, "helicoid: {}\n", message);
  return kCouldNot;
}

void report_warning(const std::string& message) {
  fmt::print(stderr, "warning: {}\n", message);
}

}  // namespace helicoid
