// What happened during an exploration, in the order in which it did (contract: events.json).
#pragma once

#include <string>
#include <vector>

namespace helicoid {

/// What an entry is about; its name is its kind in events.json.
enum class JournalKind : std::uint8_t {
  joined,      ///< a robot began
  died,        ///< a robot fell silent for good
  goal,        ///< a robot was given somewhere to go
  blocked,     ///< it could not get on, and another way is looked for
  merge,       ///< two islands were joined
  closure,     ///< a loop was closed
  rendezvous,  ///< two robots stood at places that look alike, or were sent there
  collision,   ///< a robot touched something
  radio,       ///< a robot is out of contact, or back
  end,
};
[[nodiscard]] const char* name_of(JournalKind kind);

struct JournalEntry {
  double stamp = 0;  ///< seconds since the first robot began
  JournalKind kind = JournalKind::goal;
  std::string robot;  ///< empty: the team
  std::string text;   ///< a sentence
};

using ExploreJournal = std::vector<JournalEntry>;

/// One JSON object: `format`, `version`, `events[]{t, kind, robot, text}`.
[[nodiscard]] std::string to_json(const ExploreJournal& journal);

}  // namespace helicoid
