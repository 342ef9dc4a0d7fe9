#define HELICOID_PROCESSOR_CLASS "portable"
#include "helicoid/fit/front_kernels_impl.hpp"

namespace helicoid {

const FrontKernels& portable_front_kernels() {
  return kKernels;
}

}  // namespace helicoid
