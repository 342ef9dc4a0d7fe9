# How every target is compiled and linked.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM)
  # Paths count from the project's root, so that another checkout finds what this one compiled.
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} CCACHE_NOHASHDIR=1
                                  ${CCACHE_PROGRAM})
endif()
foreach(linker mold lld)
  find_program(LINKER_${linker} NAMES ld.${linker} ${linker})
  if(LINKER_${linker})
    add_link_options(-fuse-ld=${linker})
    break()
  endif()
endforeach()

# g++ 12 warns of overlaps inside std::string that cannot be (GCC bug 105651): -Wno-restrict.
# Results must not depend on how a compiler contracts a*b+c: to the bit, on every machine of a class.
add_library(helicoid_compile_options INTERFACE)
target_compile_options(helicoid_compile_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wno-restrict -Wnon-virtual-dtor -Wold-style-cast
  -ffp-contract=off -fno-math-errno -fno-trapping-math $<$<BOOL:${HELICOID_WARNINGS_AS_ERRORS}>:-Werror>)

set(HELICOID_SANITIZE "" CACHE STRING "Sanitizers to build with, e.g. address,undefined or thread")
if(HELICOID_SANITIZE)
  add_compile_options(-fsanitize=${HELICOID_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${HELICOID_SANITIZE})
endif()
