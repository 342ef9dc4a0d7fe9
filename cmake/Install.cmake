# An installed tree that others use by find_package(helicoid COMPONENTS room ...).
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
get_property(rooms GLOBAL PROPERTY HELICOID_ROOMS)
list(TRANSFORM rooms PREPEND helicoid_ OUTPUT_VARIABLE room_targets)
install(TARGETS ${room_targets} EXPORT helicoid)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/helicoid TYPE INCLUDE FILES_MATCHING PATTERN "*.hpp")

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/helicoid)
set(HELICOID_PACKAGE_ROOMS ${rooms})
set(HELICOID_PACKAGE_LINKS "")
foreach(room ${rooms})
  get_property(links GLOBAL PROPERTY HELICOID_LINKS_${room})
  string(APPEND HELICOID_PACKAGE_LINKS "set(helicoid_links_${room} \"${links}\")\n")
endforeach()
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/helicoidConfig.cmake.in
  ${PROJECT_BINARY_DIR}/package/helicoidConfig.cmake INSTALL_DESTINATION ${package_folder}
  NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/package/helicoidConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(EXPORT helicoid FILE helicoidTargets.cmake NAMESPACE helicoid:: DESTINATION ${package_folder})
install(FILES ${PROJECT_BINARY_DIR}/package/helicoidConfig.cmake ${PROJECT_BINARY_DIR}/package/helicoidConfigVersion.cmake
  ${CMAKE_CURRENT_LIST_DIR}/ThirdParty.cmake DESTINATION ${package_folder})
