#include "apps/ledger_json.hpp"

#include <array>
#include <nlohmann/json.hpp>

#include "helicoid/io/text_file.hpp"

namespace helicoid {

namespace {

using Json = nlohmann::ordered_json;

/// Of a sighting: the robot's name (as it was reported) and the time of the sighting.
Json place_json(const Map& map, const RobotAtStamp& place, PatchId id) {
  const Pose2& T = map.T_plane_patch(id);
  return {{"robot", place.robot}, {"stamp", place.stamp}, {"patch", id.value}, {"xy", {T.x, T.y}}};
}

Json entry_json(const Map& map, const Hypothesis& h, std::size_t id) {
  const Matrix3d& C = h.T_a_b.covariance;
  const Pose2& T = h.T_a_b.T_a_b;
  return {{"id", id},
          {"state", name_of(h.state)},
          {"source", name_of(h.source)},
          {"a", place_json(map, first_place(map, h), h.a)},
          {"b", place_json(map, second_place(map, h), h.b)},
          {"T_a_b", {T.x, T.y, T.yaw}},
          {"covariance", {C(0, 0), C(0, 1), C(0, 2), C(1, 1), C(1, 2), C(2, 2)}},
          {"score", h.score},
          {"ambiguity", h.ambiguity},
          {"contradicted", h.contradicted},
          {"supports", h.supports},
          {"conflicts", h.conflicts},
          {"observer", h.seen ? Json(h.seen->observer_first ? "a" : "b") : Json()},
          {"identified_as", h.seen && h.seen->identified.valid() ? Json(map.robot(h.seen->identified).name) : Json()},
          {"reason", h.reason},
          {"decided_by", h.decided_by == DecidedBy::nobody ? Json() : Json(name_of(h.decided_by))},
          {"decided_with", h.decided_with ? Json(*h.decided_with) : Json()},
          {"event", map.patch(h.b).scan_index}};
}

/// The first of the values that has this name.
template <class T, std::size_t n>
std::optional<T> value_of_name(const std::array<T, n>& values, std::string_view name) {
  for (const T value : values) {
    if (name == name_of(value)) return value;
  }
  return std::nullopt;
}

RobotAtStamp robot_of(const Json& place) {
  return {place.at("robot").get<std::string>(), place.at("stamp").get<double>()};
}
PatchId patch_of(const Json& place) {
  return make_id<PatchId>(place.at("patch").get<std::size_t>());
}

/// Throws what the JSON library throws where something is missing.
RecordedEntry recorded_entry(const Json& json) {
  constexpr std::array kDeciders{DecidedBy::evidence, DecidedBy::sighting, DecidedBy::operator_};
  RecordedEntry entry;
  Hypothesis& h = entry.hypothesis;
  h.state = state_of_name(json.at("state").get<std::string>()).value_or(HypothesisState::open);
  h.source = source_of_name(json.at("source").get<std::string>()).value_or(HypothesisSource::lookalike);
  h.a = patch_of(json.at("a"));
  h.b = patch_of(json.at("b"));
  const auto T = json.at("T_a_b").get<std::array<double, 3>>();
  h.T_a_b.T_a_b = {T[0], T[1], T[2]};
  const auto C = json.at("covariance").get<std::array<double, 6>>();
  h.T_a_b.covariance << C[0], C[1], C[2], C[1], C[3], C[4], C[2], C[4], C[5];
  h.score = json.at("score").get<double>();
  h.ambiguity = json.at("ambiguity").get<double>();
  h.contradicted = json.at("contradicted").get<double>();
  h.supports = json.at("supports").get<std::vector<std::size_t>>();
  h.conflicts = json.at("conflicts").get<std::vector<std::size_t>>();
  h.reason = json.at("reason").get<std::string>();
  if (const Json& who = json.at("decided_by"); who.is_string()) {
    h.decided_by = value_of_name(kDeciders, who.get<std::string>()).value_or(DecidedBy::nobody);
  }
  if (const Json& with = json.at("decided_with"); with.is_number()) h.decided_with = with.get<std::size_t>();
  entry.a = robot_of(json.at("a"));
  entry.b = robot_of(json.at("b"));
  return entry;
}

}  // namespace

std::optional<HypothesisState> state_of_name(std::string_view name) {
  return value_of_name(std::array{HypothesisState::open, HypothesisState::accepted, HypothesisState::rejected,
                                  HypothesisState::distinct},
                       name);
}
std::optional<HypothesisSource> source_of_name(std::string_view name) {
  return value_of_name(std::array{HypothesisSource::lookalike, HypothesisSource::sighting, HypothesisSource::operator_},
                       name);
}

Result<std::vector<RecordedEntry>> read_ledger(const std::string& path) {
  const Result<TextFile> text = read_text_file(path);
  if (!text) return tl::unexpected(text.error());
  return parse_ledger(text->text, path);
}

Result<std::vector<RecordedEntry>> parse_ledger(const std::string& text, const std::string& name) {
  const Json json = Json::parse(text, nullptr, false);
  if (!json.is_object() || !json.contains("entries")) return fail("{}: is no ledger; `helicoid map` writes one", name);
  std::vector<RecordedEntry> entries;
  try {
    for (const Json& entry : json["entries"]) entries.push_back(recorded_entry(entry));
    // Entries speak of one another by number.
    for (const RecordedEntry& entry : entries) {
      for (const std::size_t i : entry.hypothesis.supports) std::ignore = entries.at(i);
      for (const std::size_t i : entry.hypothesis.conflicts) std::ignore = entries.at(i);
      std::ignore = entries.at(entry.hypothesis.decided_with.value_or(0));
    }
  } catch (const std::exception& error) {
    return fail("{}: entry {} is damaged ({}); map the logs again", name, entries.size(), error.what());
  }
  return entries;
}

std::string ledger_json(const Map& map, const Ledger& ledger) {
  Json entries = Json::array();
  for (std::size_t i = 0; i < ledger.size(); ++i) entries.push_back(entry_json(map, ledger[i], i));
  const Json json = {{"format", "helicoid-ledger"}, {"entries", entries}};
  return json.dump(1) + "\n";
}

}  // namespace helicoid
