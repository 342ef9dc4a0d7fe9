// ledger.json (contract: `explain`, `ledger`).
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "helicoid/base/result.hpp"
#include "helicoid/mapping/decision.hpp"

namespace helicoid {

/// The ledger's entries in the order in which they were made, at the map's final poses.
[[nodiscard]] std::string ledger_json(const Map& map, const Ledger& ledger);

/// An entry as a file has it; its number is its place in the file.
struct RecordedEntry {
  Hypothesis hypothesis;
  RobotAtStamp a, b;
};

/// `name` is what messages call the text. Error: it is no ledger, or damaged.
[[nodiscard]] Result<std::vector<RecordedEntry>> parse_ledger(const std::string& text, const std::string& name);
/// Errors: as parse_ledger, or the file cannot be read.
[[nodiscard]] Result<std::vector<RecordedEntry>> read_ledger(const std::string& path);

/// The other way round than name_of.
[[nodiscard]] std::optional<HypothesisState> state_of_name(std::string_view name);
[[nodiscard]] std::optional<HypothesisSource> source_of_name(std::string_view name);

}  // namespace helicoid
