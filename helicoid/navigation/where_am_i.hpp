// "Where am I?" for a robot that was put down anywhere: places of the map at which a scan fits, and how sure that is.
#pragma once

#include <optional>
#include <vector>

#include "helicoid/manifold/neighbours.hpp"
#include "helicoid/sensor/event.hpp"

namespace helicoid {

struct WhereAmIOptions {
  double spacing = 2.0;        ///< between the places that are tried, metres
  std::size_t views = 6;       ///< patches that show what is about a place
  double reach = 1.6;          ///< that a place is searched about it, to either side, metres
  double least_score = 0.5;    ///< of a search (align/place_search): fits worse than that are none
  std::size_t refined = 12;    ///< of the best fits are aligned
  double apart = 0.8;          ///< two fits this near are one, metres
  double apart_heading = 0.3;  ///< radians
};

/// One place at which the robot may stand.
struct PlaceHypothesis {
  ManifoldPose pose;
  double inlier_share = 0;   ///< of the scan's points: on surfaces that the map has there
  double against_share = 0;  ///< of the scan's points: where patches saw free space
  /// That it is this one of all the places that were looked at, 0..1. They sum to less than one: it may be nowhere.
  double confidence = 0;
};

struct SheetSearchOptions {
  double reach = 1.0;               ///< that the robot may be off from where the plane has it, to either side, metres
  double turn = 0.15;               ///< the same of its heading, radians
  double least_inlier_share = 0.7;  ///< of the scan's points on what is known about the patch
  double most_against = 0.03;       ///< share of them in what the patches there saw as free
  /// The best place explains this many times as much as the next best, or a scan fits along a corridor anywhere.
  double clearer = 1.1;
};

/// The likeliest first; none where the scan fits nowhere. Sheets are places of their own: what is shown about a place
/// is what its patch and the neighbours of that say.
[[nodiscard]] std::vector<PlaceHypothesis> where_am_i(const Map& map, const Neighbours& neighbours, const Scan& scan,
                                                      const LaserModel& laser, const WhereAmIOptions& options = {});

/// Where a robot stands relative to a patch that lies about it in the plane, but on another sheet than its own, so that
/// the map does not say it well: by what its scan shows alone. Nothing where it does not fit, or in several ways.
[[nodiscard]] std::optional<ManifoldPose> find_on_sheet(const Map& map, const Neighbours& neighbours, PatchId patch,
                                                        const ManifoldPose& robot, const Scan& scan,
                                                        const LaserModel& laser,
                                                        const SheetSearchOptions& options = {});

}  // namespace helicoid
