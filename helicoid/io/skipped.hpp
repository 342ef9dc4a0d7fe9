// Nothing is skipped without being counted and shown.
#pragma once

#include <string>
#include <vector>

namespace helicoid {

/// One way in which input was left out, with the first place where it happened.
struct Skipped {
  std::string reason;
  std::size_t count = 0;
  std::string first;  ///< "robot2.log:812: ..."
};

/// Counts by reason, in the order in which reasons first turned up.
class SkipCounter {
 public:
  /// `describe` makes the text of the first place; it is called only once a reason.
  template <class Describe>
  void add(const char* reason, Describe&& describe) {
    for (Skipped& s : skipped_) {
      if (s.reason == reason) {
        ++s.count;
        return;
      }
    }
    skipped_.push_back({reason, 1, describe()});
  }
  [[nodiscard]] const std::vector<Skipped>& all() const { return skipped_; }

 private:
  std::vector<Skipped> skipped_;
};

}  // namespace helicoid
