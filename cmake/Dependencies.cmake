# The third parties; each is linked only by the room that may use it. The installed package finds them by the same file.
include(${CMAKE_CURRENT_LIST_DIR}/ThirdParty.cmake)
foreach(target Threads::Threads Eigen3::Eigen fmt::fmt tl::expected PNG::PNG ZLIB::ZLIB SQLite::SQLite3 pugixml::pugixml
    GEOS::geos_c libdeflate::libdeflate Cairo::cairo AMD::amd METIS::metis)
  helicoid_find_third_party(${target})
endforeach()
# The edge's own.
find_package(CLI11 REQUIRED)
find_package(nlohmann_json REQUIRED)
