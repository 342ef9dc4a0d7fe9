#include "helicoid/fit/front_kernels.hpp"

#include <algorithm>

namespace helicoid {

#if defined(HELICOID_X86_KERNELS)
extern const FrontKernels& avx2_front_kernels();
extern const FrontKernels& avx512_front_kernels();
#endif

std::size_t FrontShape::workspace_size() const {
  const auto height = static_cast<std::size_t>(leading());
  const auto width = static_cast<std::size_t>(padded(pivots));
  // Packed panels of `eliminate`; X, two transposes and a square of `invert`.
  return std::max<std::size_t>(height * kBand, height * width + 2 * height * width + width * width);
}

const FrontKernels& front_kernels() {
#if defined(HELICOID_X86_KERNELS)
  static const bool has_avx512 = __builtin_cpu_supports("avx512f") != 0;
  static const bool has_avx2 = __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0;
  if (has_avx512) return avx512_front_kernels();
  if (has_avx2) return avx2_front_kernels();
#endif
  return portable_front_kernels();
}

}  // namespace helicoid
