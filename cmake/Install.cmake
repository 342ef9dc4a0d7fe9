# An installed tree that others use by find_package(helicoid).
include(CMakePackageConfigHelpers)
get_property(rooms GLOBAL PROPERTY HELICOID_ROOMS)
list(TRANSFORM rooms PREPEND helicoid_ OUTPUT_VARIABLE room_targets)
install(TARGETS ${room_targets} EXPORT helicoidTargets)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/helicoid TYPE INCLUDE FILES_MATCHING PATTERN "*.hpp")
