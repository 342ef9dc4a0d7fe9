#include "helicoid/mapping/ledger.hpp"

#include <algorithm>

namespace helicoid {

const char* name_of(HypothesisState state) {
  switch (state) {
    case HypothesisState::open: return "open";
    case HypothesisState::accepted: return "accepted";
    case HypothesisState::rejected: return "rejected";
    case HypothesisState::distinct: return "distinct";
  }
  return "unknown";
}

const char* name_of(HypothesisSource source) {
  switch (source) {
    case HypothesisSource::lookalike: return "lookalike";
    case HypothesisSource::sighting: return "sighting";
    case HypothesisSource::operator_: return "operator";
  }
  return "unknown";
}

const char* name_of(DecidedBy who) {
  switch (who) {
    case DecidedBy::nobody: return "nobody";
    case DecidedBy::evidence: return "evidence";
    case DecidedBy::sighting: return "sighting";
    case DecidedBy::operator_: return "operator";
  }
  return "unknown";
}

std::size_t count_closures(const Ledger& ledger) {
  return static_cast<std::size_t>(
      std::count_if(ledger.begin(), ledger.end(), [](const Hypothesis& h) { return h.is_closure(); }));
}

}  // namespace helicoid
