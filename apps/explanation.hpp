// Why a map believes what it believes, in sentences: an answer to a colleague.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/ledger_json.hpp"

namespace helicoid {

/// A place that somebody asks about.
struct AskedPlace {
  std::string name;  ///< as it was asked for
  PatchId patch;
  Pose2 T_patch_place;
};

struct Explanation {
  std::vector<std::string> paragraphs;
  nlohmann::ordered_json figures;  ///< the numbers in them
};

/// Of an entry of the ledger: what was compared, what agrees and what does not, what it does to the map.
[[nodiscard]] Explanation explain_entry(const Map& map, const std::vector<RecordedEntry>& ledger, std::size_t id);

/// Of two places: how well one is known relative to the other, by what, and which entries of the ledger speak of them.
[[nodiscard]] Explanation explain_places(const Map& map, const std::vector<RecordedEntry>& ledger, const AskedPlace& a,
                                         const AskedPlace& b);

}  // namespace helicoid
