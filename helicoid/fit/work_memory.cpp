#include "helicoid/fit/work_memory.hpp"

#include <sys/mman.h>
#if defined(__GLIBC__)
#include <malloc.h>
#endif

#include <cstdlib>
#include <new>

namespace helicoid {

void WorkMemory::Free::operator()(double* memory) const {
  std::free(memory);
}

WorkMemory::WorkMemory(std::size_t size) : size_(size) {
  constexpr std::size_t kLargePage = std::size_t{1} << 21U;
  constexpr std::size_t kCacheLine = 64;
  const std::size_t bytes = sizeof(double) * size;
  const std::size_t alignment = bytes >= 4 * kLargePage ? kLargePage : kCacheLine;
  const std::size_t whole = (bytes + alignment - 1) / alignment * alignment;
  if (whole == 0) return;
  memory_.reset(static_cast<double*>(std::aligned_alloc(alignment, whole)));
  if (!memory_) throw std::bad_alloc();
#if defined(MADV_HUGEPAGE)
  // A wish: where it is not granted nothing but time is lost.
  if (alignment == kLargePage) madvise(memory_.get(), whole, MADV_HUGEPAGE);
#endif
}

void release_free_memory() {
#if defined(__GLIBC__)
  malloc_trim(0);
#endif
}

}  // namespace helicoid
