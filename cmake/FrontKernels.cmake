# The dense kernels of helicoid/fit are compiled once for each class of processors and chosen at run time. There alone
# may a compiler contract a*b+c: results are to the bit on one class, and to rounding between classes.
set(kernels ${PROJECT_SOURCE_DIR}/helicoid/fit/front_kernels)
set_source_files_properties(${kernels}_portable.cpp PROPERTIES COMPILE_OPTIONS "-O3")
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64|i.86")
  target_compile_definitions(helicoid_fit PRIVATE HELICOID_X86_KERNELS)
  set_source_files_properties(${kernels}_avx2.cpp PROPERTIES COMPILE_OPTIONS "-O3;-mavx2;-mfma;-ffp-contract=fast")
  set_source_files_properties(${kernels}_avx512.cpp PROPERTIES COMPILE_OPTIONS
    "-O3;-mavx512f;-mfma;-mprefer-vector-width=512;-ffp-contract=fast")
endif()
