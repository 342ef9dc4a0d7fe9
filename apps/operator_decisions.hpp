// What an operator says about one entry of a ledger, as decisions for a replay.
#pragma once

#include <vector>

#include "apps/ledger_json.hpp"

namespace helicoid {

enum class LedgerAction : std::uint8_t { accept, reject, undo };

struct OperatorDecisions {
  std::vector<Decision> decisions;    ///< all, the earlier ones that stand included
  std::vector<std::size_t> concerns;  ///< the entries that the action speaks of, ascending
};

/// Accept: the entry holds whatever else agrees. Reject: neither it nor those that were accepted with it are acted on.
/// Undo: takes back what the operator said about it; of what the program accepted by itself, leaves the whole set open.
/// Errors: there is no such entry, or nothing to be done about it.
[[nodiscard]] Result<OperatorDecisions> decide(const std::vector<RecordedEntry>& ledger, std::vector<Decision> earlier,
                                               LedgerAction action, std::size_t id);

}  // namespace helicoid
