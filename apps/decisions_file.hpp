// decisions.json: what an operator decided about entries of a ledger (contract: `--decisions FILE`).
#pragma once

#include <string>
#include <vector>

#include "helicoid/base/result.hpp"
#include "helicoid/mapping/decision.hpp"

namespace helicoid {

/// Errors: the file cannot be read, is no JSON, or a decision lacks something; the message counts them from 1.
[[nodiscard]] Result<std::vector<Decision>> read_decisions(const std::string& path);
[[nodiscard]] std::string decisions_json(const std::vector<Decision>& decisions);

}  // namespace helicoid
