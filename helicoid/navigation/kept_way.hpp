// Whether a robot keeps the way that it is on, though another one has been planned since.
#pragma once

#include "helicoid/navigation/plan_route.hpp"

namespace helicoid {

/// While a robot drives on known ground the map may wind up another sheet under it. From there a plan to where it was
/// going leads back to where the two sheets part, and on the way the same happens again: robots go to and fro for good.
/// True if `found` does so and `route` will do: it has `left` metres to go, the new one over `longer` metres more, and
/// by what is known now there is room for a robot all along what is left.
[[nodiscard]] bool only_leads_back(const NavigableMap& map, const ManifoldRoute& route, double left,
                                   const ManifoldRoute& found, double longer = 1.5);

}  // namespace helicoid
