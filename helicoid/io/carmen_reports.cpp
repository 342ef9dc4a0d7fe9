// What a robot's log says of other robots and places: the lines that are ours, not CARMEN's.
#include <cmath>

#include "helicoid/io/carmen_reader.hpp"
#include "helicoid/io/number.hpp"

namespace helicoid {

std::string CarmenReader::read_name(TextCursor& cursor) {
  cursor.skip_blanks();
  const char* name = cursor.at;
  while (cursor.at != cursor.end && *cursor.at != ' ') ++cursor.at;
  return {name, cursor.at};
}

const Event* CarmenReader::parse_lookalike(TextCursor cursor) {
  Lookalike alike;
  alike.robot = read_name(cursor);
  double values[7] = {};  // stamp there, x, y, yaw, their sigmas, stamp
  bool ok = true;
  for (double& value : values) {
    const ReadNumber number = read_number(cursor);
    ok = ok && number.ok && std::isfinite(number.value);
    value = number.value;
  }
  if (!ok || values[4] <= 0 || values[5] <= 0) return skip("look-alike with wrong numbers", "LOOKALIKE");
  alike.stamp = values[0];
  alike.T_there_robot = {values[1], values[2], wrap_angle(values[3])};
  alike.sigma_position = values[4];
  alike.sigma_heading = values[5];
  other_event_.stamp = values[6];
  other_event_.body = std::move(alike);
  return &other_event_;
}

const Event* CarmenReader::parse_sighting(TextCursor cursor) {
  Sighting sighting;
  sighting.observed = read_name(cursor);
  double values[7] = {};  // range bearing orientation, their sigmas, stamp
  for (double& value : values) {
    const ReadNumber number = read_number(cursor);
    if (!number.ok) return skip("sighting with wrong numbers", "SIGHTING");
    value = number.value;
  }
  const auto measured = [](double v) { return std::isfinite(v) ? std::optional<double>(v) : std::nullopt; };
  sighting.range = measured(values[0]);
  sighting.bearing = measured(values[1]);
  sighting.orientation = measured(values[2]);
  sighting.sigma_range = values[3];
  sighting.sigma_bearing = values[4];
  sighting.sigma_orientation = values[5];
  if (!std::isfinite(values[6])) return skip("sighting with wrong numbers", "SIGHTING");
  other_event_.stamp = values[6];
  other_event_.body = std::move(sighting);
  return &other_event_;
}

}  // namespace helicoid
