#include "helicoid/fit/pose_marks.hpp"

#include <algorithm>

namespace helicoid {

namespace {

/// Tables that are not in use; every entry is kNone.
std::vector<std::vector<std::int32_t>>& free_tables() {
  thread_local std::vector<std::vector<std::int32_t>> tables;
  return tables;
}

}  // namespace

PoseMarks::PoseMarks(std::size_t poses) {
  std::vector<std::vector<std::int32_t>>& tables = free_tables();
  if (!tables.empty()) {
    table_ = std::move(tables.back());
    tables.pop_back();
  }
  if (table_.size() < poses) table_.resize(poses, kNone);
}

PoseMarks::~PoseMarks() {
  for (const std::uint32_t pose : marked_) table_[pose] = kNone;
  free_tables().push_back(std::move(table_));
}

}  // namespace helicoid
