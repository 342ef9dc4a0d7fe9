// What the incremental step decides by. Lengths in metres, angles in radians. One set for every log.
#pragma once

namespace helicoid {

struct MapperOptions {
  /// A patch belongs to the reference of a match if it is known to this, relative to the robot's patch (eq. 12's eps).
  double reference_position = 0.10;
  double reference_heading = 0.035;
  /// The first trigger of a new patch: this far from every patch of the local map.
  double patch_spacing = 1.0;
  double patch_turn = 0.70;
  /// The second: this share of the scan's free space is not covered by the local map.
  double new_ground_share = 0.20;
};

}  // namespace helicoid
