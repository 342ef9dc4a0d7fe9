// How far it is for a robot.
#pragma once

#include <functional>

#include "helicoid/navigation/manifold_point.hpp"

namespace helicoid {

/// Metres from one robot to a place on the manifold by the shortest way that is known; infinity if there is none.
using Travel = std::function<double(const ManifoldPoint&)>;

}  // namespace helicoid
