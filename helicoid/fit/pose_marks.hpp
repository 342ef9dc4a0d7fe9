// A number on some poses of a graph, at the cost of those poses alone: a table of all would cost a large map more than
// what is looked for in it.
#pragma once

#include <cstdint>
#include <vector>

namespace helicoid {

/// Borrows a table of its thread, which lies ready between two uses with no pose marked.
class PoseMarks {
 public:
  static constexpr std::int32_t kNone = -1;
  /// For the poses of a graph of this size.
  explicit PoseMarks(std::size_t poses);
  ~PoseMarks();
  PoseMarks(const PoseMarks&) = delete;
  PoseMarks& operator=(const PoseMarks&) = delete;

  [[nodiscard]] std::int32_t operator[](std::uint32_t pose) const { return table_[pose]; }
  void set(std::uint32_t pose, std::int32_t mark) {
    if (table_[pose] == kNone) marked_.push_back(pose);
    table_[pose] = mark;
  }

 private:
  std::vector<std::int32_t> table_;
  std::vector<std::uint32_t> marked_;
};

}  // namespace helicoid
