#include "apps/operator_decisions.hpp"

#include <algorithm>

namespace helicoid {

namespace {

/// The entries that were decided with this one, ascending: accepted in one set, or by the operator's word about one
/// that says the same. Those about which the operator spoke himself are known by their agreement.
std::vector<std::size_t> decided_together(const std::vector<RecordedEntry>& ledger, std::size_t id) {
  const auto leader = [&](std::size_t i) { return ledger[i].hypothesis.decided_with.value_or(i); };
  const std::size_t chief = leader(id);
  const Hypothesis& of_chief = ledger[chief].hypothesis;
  const auto agrees = [&](std::size_t i, std::size_t k) {
    const std::vector<std::size_t>& supports = ledger[std::max(i, k)].hypothesis.supports;
    return std::find(supports.begin(), supports.end(), std::min(i, k)) != supports.end();
  };
  std::vector<std::size_t> together;
  for (std::size_t i = 0; i < ledger.size(); ++i) {
    const Hypothesis& h = ledger[i].hypothesis;
    const bool same_word = h.decided_by == DecidedBy::operator_ && of_chief.decided_by == DecidedBy::operator_ &&
                           h.state == of_chief.state && agrees(i, chief);
    if (leader(i) == chief || same_word) together.push_back(i);
  }
  return together;
}

/// Takes out the decisions about these entries, and those that were made in one act with them: without what was decided
/// then, some of its entries may never have come up again.
void take_back(std::vector<Decision>& decisions, const std::vector<RecordedEntry>& ledger,
               const std::vector<std::size_t>& entries) {
  std::vector<std::size_t> acts;
  std::erase_if(decisions, [&](const Decision& d) {
    const bool concerned = std::any_of(entries.begin(), entries.end(), [&](std::size_t i) {
      return is_about(d, ledger[i].hypothesis.source, ledger[i].a, ledger[i].b);
    });
    if (concerned && d.act > 0) acts.push_back(d.act);
    return concerned;
  });
  std::erase_if(decisions, [&](const Decision& d) { return std::find(acts.begin(), acts.end(), d.act) != acts.end(); });
}

Result<void> is_possible(const Hypothesis& h, LedgerAction action, std::size_t id) {
  const bool by_operator = h.decided_by == DecidedBy::operator_;
  if (action == LedgerAction::accept && h.state == HypothesisState::accepted) {
    return fail("entry {} is accepted already: {}", id, h.reason);
  }
  if (action == LedgerAction::reject && h.state == HypothesisState::rejected && by_operator) {
    return fail("entry {} is rejected already: {}", id, h.reason);
  }
  if (action == LedgerAction::undo && !by_operator && h.state != HypothesisState::accepted) {
    return fail("entry {} is {} and nobody's decision: there is nothing to undo", id, name_of(h.state));
  }
  return {};
}

}  // namespace

Result<OperatorDecisions> decide(const std::vector<RecordedEntry>& ledger, std::vector<Decision> earlier,
                                 LedgerAction action, std::size_t id) {
  if (id >= ledger.size()) {
    return fail("there is no entry {}; the ledger has {} (`helicoid ledger MAP` lists them)", id, ledger.size());
  }
  const Hypothesis& h = ledger[id].hypothesis;
  if (auto possible = is_possible(h, action, id); !possible) return tl::unexpected(possible.error());
  std::size_t act = 1;
  for (const Decision& d : earlier) act = std::max(act, d.act + 1);
  OperatorDecisions result{std::move(earlier), decided_together(ledger, id)};
  take_back(result.decisions, ledger, result.concerns);
  const auto say = [&](std::size_t i, HypothesisState state) {
    result.decisions.push_back({state, ledger[i].hypothesis.source, ledger[i].a, ledger[i].b, act});
  };
  if (action == LedgerAction::accept) {
    result.concerns = {id};
    say(id, HypothesisState::accepted);
  } else if (action == LedgerAction::reject) {
    for (const std::size_t i : result.concerns) say(i, HypothesisState::rejected);
  } else if (h.decided_by != DecidedBy::operator_) {
    for (const std::size_t i : result.concerns) say(i, HypothesisState::open);
  }
  return result;
}

}  // namespace helicoid
