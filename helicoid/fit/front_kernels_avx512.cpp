// Compiled for AVX-512; called only where the processor has it.
#if defined(__AVX512F__)
#define HELICOID_PROCESSOR_CLASS "avx512"
#include "helicoid/fit/front_kernels_impl.hpp"

namespace helicoid {

extern const FrontKernels& avx512_front_kernels();
const FrontKernels& avx512_front_kernels() {
  return kKernels;
}

}  // namespace helicoid
#endif
