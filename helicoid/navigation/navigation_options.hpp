// What a robot needs to drive.
#pragma once

namespace helicoid {

struct NavigationOptions {
  double robot_radius = 0.20;  ///< metres
  double margin = 0.03;        ///< kept from obstacles beyond the radius, metres
  double comfortable = 0.50;   ///< clearance that is sought where there is room; 0.8 at most; metres
  /// By what a metre at the least clearance costs more than one in comfort, as a share.
  double discomfort = 3;
  /// A robot or a goal this near to floor that may be driven counts as standing on it, metres.
  double reach = 0.45;

  /// The clearance without which no route leads anywhere.
  [[nodiscard]] double least_clearance() const { return robot_radius + margin; }
};

}  // namespace helicoid
