#include "apps/decisions_file.hpp"

#include <nlohmann/json.hpp>
#include <optional>

#include "apps/ledger_json.hpp"
#include "helicoid/io/text_file.hpp"

namespace helicoid {

namespace {

using Json = nlohmann::ordered_json;

std::optional<RobotAtStamp> place_of(const Json& decision, const char* key) {
  const auto place = decision.find(key);
  if (place == decision.end() || !place->is_object()) return std::nullopt;
  const auto robot = place->find("robot");
  const auto stamp = place->find("stamp");
  if (robot == place->end() || !robot->is_string() || stamp == place->end() || !stamp->is_number()) return std::nullopt;
  return RobotAtStamp{robot->get<std::string>(), stamp->get<double>()};
}

std::string text_of(const Json& decision, const char* key) {
  const auto value = decision.find(key);
  return value != decision.end() && value->is_string() ? value->get<std::string>() : std::string{};
}

Result<Decision> decision_of(const Json& json, const std::string& path, std::size_t number) {
  if (!json.is_object()) return fail("{}: decision {} is no object", path, number);
  const std::optional<HypothesisState> state = state_of_name(text_of(json, "state"));
  if (!state) return fail("{}: decision {} needs a \"state\": accepted, rejected, distinct or open", path, number);
  const std::optional<HypothesisSource> source = source_of_name(text_of(json, "source"));
  if (!source) return fail("{}: decision {} needs a \"source\": lookalike, sighting or operator", path, number);
  const std::optional<RobotAtStamp> a = place_of(json, "a");
  const std::optional<RobotAtStamp> b = place_of(json, "b");
  if (!a || !b) return fail("{}: decision {} needs \"a\" and \"b\", each with \"robot\" and \"stamp\"", path, number);
  const auto act = json.find("act");
  return Decision{*state, *source, *a, *b,
                  act != json.end() && act->is_number_unsigned() ? act->get<std::size_t>() : 0};
}

}  // namespace

Result<std::vector<Decision>> read_decisions(const std::string& path) {
  const Result<TextFile> text = read_text_file(path);
  if (!text) return tl::unexpected(text.error());
  const Json json = Json::parse(text->text, nullptr, false);
  const auto list = json.is_object() ? json.find("decisions") : json.end();
  if (json.is_discarded() || !json.is_object() || list == json.end() || !list->is_array()) {
    return fail("{}: is no file of decisions; `helicoid ledger MAP accept ID --out DIR` writes one: DIR/decisions.json",
                path);
  }
  std::vector<Decision> decisions;
  for (const Json& entry : *list) {
    Result<Decision> decision = decision_of(entry, path, decisions.size() + 1);
    if (!decision) return tl::unexpected(decision.error());
    decisions.push_back(std::move(*decision));
  }
  return decisions;
}

std::string decisions_json(const std::vector<Decision>& decisions) {
  Json list = Json::array();
  for (const Decision& d : decisions) {
    list.push_back({{"state", name_of(d.state)},
                    {"source", name_of(d.source)},
                    {"a", {{"robot", d.a.robot}, {"stamp", d.a.stamp}}},
                    {"b", {{"robot", d.b.robot}, {"stamp", d.b.stamp}}},
                    {"act", d.act}});
  }
  return Json{{"format", "helicoid-decisions"}, {"decisions", list}}.dump(1) + "\n";
}

}  // namespace helicoid
