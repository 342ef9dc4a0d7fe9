// Whatever a log holds, it is read to its end and its scans become points and free space.
#include <cstdint>
#include <cstdlib>
#include <optional>

#include "helicoid/io/carmen_reader.hpp"
#include "helicoid/sensor/free_space.hpp"
#include "helicoid/sensor/scan_points.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace helicoid;
  CarmenReader reader({{"fuzz.log", std::string(reinterpret_cast<const char*>(data), size), {}}}, make_id<RobotId>(0));
  std::vector<std::optional<ScanPointExtractor>> extractors(reader.lasers().size());
  while (const Event* event = reader.next()) {
    const auto* scan = std::get_if<Scan>(&event->body);
    if (scan == nullptr) continue;
    const LaserModel& laser = reader.lasers().at(static_cast<std::size_t>(scan->laser));
    auto& extractor = extractors[static_cast<std::size_t>(scan->laser)];
    if (!extractor) extractor.emplace(laser);
    const std::size_t points = extractor->extract(*scan).size();
    const std::size_t vertices = free_space_polygon(*scan, laser, make_beam_table(laser)).size();
    if (points > scan->ranges.size() || vertices > 2 * scan->ranges.size() + 1) std::abort();
  }
  if (reader.bytes_done() < size) std::abort();
  return 0;
}
