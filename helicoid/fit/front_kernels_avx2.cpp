// Compiled for AVX2 and FMA; called only where the processor has them.
#if defined(__AVX2__) && defined(__FMA__)
#define HELICOID_PROCESSOR_CLASS "avx2"
#include "helicoid/fit/front_kernels_impl.hpp"

namespace helicoid {

extern const FrontKernels& avx2_front_kernels();
const FrontKernels& avx2_front_kernels() {
  return kKernels;
}

}  // namespace helicoid
#endif
