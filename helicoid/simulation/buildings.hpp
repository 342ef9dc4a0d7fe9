// Five buildings unlike the shipped worlds, to see whether what is right there is right elsewhere.
#pragma once

#include "helicoid/simulation/building_plan.hpp"

namespace helicoid {

/// A ward: like rooms on both sides of a ring corridor of 150 m, some of which are visited. Of the furniture `moved`
/// pieces stand elsewhere than in the ward of the same seed with none moved.
[[nodiscard]] World make_hospital(std::uint64_t seed, std::size_t moved = 0);
/// Corridors of 250 m with niches at irregular distances, in a loop of 620 m that a cross corridor cuts in two.
[[nodiscard]] World make_terminal(std::uint64_t seed);
/// A hall of 54 x 30 m, its racks in rows, all of one make, their pallets here and there.
[[nodiscard]] World make_warehouse(std::uint64_t seed);
/// A corridor of 64 m between rooms that are furnished all alike; every one is visited.
[[nodiscard]] World make_dormitory(std::uint64_t seed);
/// A round corridor of 100 m with niches, and a straight one across.
[[nodiscard]] World make_rotunda(std::uint64_t seed);

/// A round corridor of 100 m, smooth all the way: the same at every angle. Its start is at angle 0.
[[nodiscard]] World make_smooth_ring();
/// A cupboard of 0.8 x 0.5 m that stands against its outer wall at this angle, radians.
[[nodiscard]] std::vector<Segment> cupboard_in_ring(double angle);

}  // namespace helicoid
