# Embeds worlds/*.svg, so that the program finds them wherever it runs.
file(GLOB world_files CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/worlds/*.svg)
set(entries "")
foreach(file ${world_files})
  get_filename_component(name ${file} NAME_WE)
  file(READ ${file} content)
  string(APPEND entries "    {\"${name}\", R\"svg(${content})svg\"},\n")
  set_property(DIRECTORY ${PROJECT_SOURCE_DIR} APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
endforeach()
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/generated/helicoid/simulation/shipped_worlds.hpp CONTENT
"// Made from worlds/*.svg by cmake/ShippedWorlds.cmake.
#pragma once

namespace helicoid {

struct ShippedWorld {
  const char* name;
  const char* svg;
};
inline constexpr ShippedWorld kShippedWorlds[] = {
${entries}};

}  // namespace helicoid
" @ONLY)
target_include_directories(helicoid_simulation PRIVATE ${PROJECT_BINARY_DIR}/generated)
