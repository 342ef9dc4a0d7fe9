#include "apps/explore_journal.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

namespace helicoid {

const char* name_of(JournalKind kind) {
  switch (kind) {
    case JournalKind::joined: return "joined";
    case JournalKind::died: return "died";
    case JournalKind::goal: return "goal";
    case JournalKind::blocked: return "blocked";
    case JournalKind::merge: return "merge";
    case JournalKind::closure: return "closure";
    case JournalKind::rendezvous: return "rendezvous";
    case JournalKind::collision: return "collision";
    case JournalKind::radio: return "radio";
    case JournalKind::end: return "end";
  }
  return "";
}

std::string to_json(const ExploreJournal& journal) {
  using Json = nlohmann::ordered_json;
  Json events = Json::array();
  for (const JournalEntry& e : journal) {
    events.push_back({{"t", std::round(1000 * e.stamp) / 1000},
                      {"kind", name_of(e.kind)},
                      {"robot", e.robot.empty() ? Json() : Json(e.robot)},
                      {"text", e.text}});
  }
  const Json all = {{"format", "helicoid-events"}, {"version", HELICOID_VERSION}, {"events", events}};
  return all.dump(1) + "\n";
}

}  // namespace helicoid
