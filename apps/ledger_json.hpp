// ledger.json (contract: `explain`, `ledger`).
#pragma once

#include <string>

#include "helicoid/manifold/map.hpp"
#include "helicoid/mapping/ledger.hpp"

namespace helicoid {

/// The ledger's entries in the order in which they were made, at the map's final poses.
[[nodiscard]] std::string ledger_json(const Map& map, const Ledger& ledger);

}  // namespace helicoid
