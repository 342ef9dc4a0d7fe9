// Memory for numbers that are written before they are read: not zeroed first, and where it is large in large pages,
// since a first touch of every 4 kB costs more than the arithmetic on it.
#pragma once

#include <cstddef>
#include <memory>

namespace helicoid {

/// So many doubles, aligned to a cache line, with any values.
class WorkMemory {
 public:
  WorkMemory() = default;
  explicit WorkMemory(std::size_t size);

  [[nodiscard]] double* data() const { return memory_.get(); }
  [[nodiscard]] std::size_t size() const { return size_; }

 private:
  struct Free {
    void operator()(double* memory) const;
  };
  std::unique_ptr<double[], Free> memory_;
  std::size_t size_ = 0;
};

/// Gives what was freed back to the system, where the C library can.
void release_free_memory();

}  // namespace helicoid
