// Functions whose loops the compiler vectorises, compiled once for each class of processors and chosen at run time. The
// operations are the same, so the bits are.
#pragma once

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define HELICOID_WIDE_LANES __attribute__((target_clones("avx2", "default")))
#else
#define HELICOID_WIDE_LANES
#endif
