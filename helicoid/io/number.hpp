// Numbers out of text, fast: plain decimals go through an exact integer and one division.
#pragma once

#include <charconv>
#include <cstdint>
#include <limits>

namespace helicoid {

/// Where reading stands in a line. Nothing is copied.
struct TextCursor {
  const char* at = nullptr;
  const char* end = nullptr;

  void skip_blanks() {
    while (at != end && (*at == ' ' || *at == '\t' || *at == '\r')) ++at;
  }
};

/// The next blank-separated word as a number. "nan" and "inf" are numbers. On anything else `ok` is false and the
/// cursor stays where the word begins.
struct ReadNumber {
  double value = 0;
  bool ok = false;
};

inline ReadNumber read_number_slow(TextCursor& cursor) {
  double value = 0;
  const char* from = cursor.at != cursor.end && *cursor.at == '+' ? cursor.at + 1 : cursor.at;
  const auto [stop, error] = std::from_chars(from, cursor.end, value);
  if (error == std::errc::result_out_of_range) {
    value = std::numeric_limits<double>::infinity();
  } else if (error != std::errc()) {
    return {};
  }
  if (stop != cursor.end && *stop != ' ' && *stop != '\t' && *stop != '\r') return {};
  cursor.at = stop;
  return {value, true};
}

inline ReadNumber read_number(TextCursor& cursor) {
  static constexpr double kPowers[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,
                                       1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19};
  cursor.skip_blanks();
  const char* p = cursor.at;
  const char* end = cursor.end;
  const bool negative = p != end && *p == '-';
  if (negative) ++p;
  std::uint64_t digits = 0;
  int count = 0;
  while (p != end && static_cast<unsigned char>(*p - '0') < 10) {
    digits = 10 * digits + static_cast<unsigned char>(*p++ - '0');
    ++count;
  }
  int decimals = 0;
  if (p != end && *p == '.') {
    ++p;
    while (p != end && static_cast<unsigned char>(*p - '0') < 10) {
      digits = 10 * digits + static_cast<unsigned char>(*p++ - '0');
      ++decimals;
    }
  }
  // Up to 2^53 the integer is exact, and so is the power of ten up to 10^22: their quotient is rounded correctly.
  const bool plain = count + decimals > 0 && count + decimals <= 19 && digits <= (std::uint64_t{1} << 53U) &&
                     (p == end || *p == ' ' || *p == '\t' || *p == '\r');
  if (!plain) return read_number_slow(cursor);
  cursor.at = p;
  const double magnitude = static_cast<double>(digits) / kPowers[decimals];
  return {negative ? -magnitude : magnitude, true};
}

}  // namespace helicoid
