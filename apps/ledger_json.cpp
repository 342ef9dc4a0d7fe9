#include "apps/ledger_json.hpp"

#include <nlohmann/json.hpp>

namespace helicoid {

namespace {

using Json = nlohmann::ordered_json;

Json place_json(const Map& map, PatchId id) {
  const Patch& patch = map.patch(id);
  const Pose2& T = map.T_plane_patch(id);
  return {{"robot", map.robot(patch.robot).name}, {"stamp", patch.stamp}, {"patch", id.value}, {"xy", {T.x, T.y}}};
}

Json entry_json(const Map& map, const Hypothesis& h, std::size_t id) {
  const Matrix3d& C = h.T_a_b.covariance;
  const Pose2& T = h.T_a_b.T_a_b;
  return {{"id", id},
          {"state", name_of(h.state)},
          {"source", name_of(h.source)},
          {"a", place_json(map, h.a)},
          {"b", place_json(map, h.b)},
          {"T_a_b", {T.x, T.y, T.yaw}},
          {"covariance", {C(0, 0), C(0, 1), C(0, 2), C(1, 1), C(1, 2), C(2, 2)}},
          {"score", h.score},
          {"ambiguity", h.ambiguity},
          {"contradicted", h.contradicted},
          {"supports", h.supports},
          {"conflicts", Json::array()},
          {"reason", h.reason},
          {"decided_by", h.state == HypothesisState::open
                             ? Json()
                             : Json(h.source == HypothesisSource::sighting ? "sighting" : "evidence")},
          {"event", map.patch(h.b).scan_index}};
}

}  // namespace

std::string ledger_json(const Map& map, const Ledger& ledger) {
  Json entries = Json::array();
  for (std::size_t i = 0; i < ledger.size(); ++i) entries.push_back(entry_json(map, ledger[i], i));
  const Json json = {{"format", "helicoid-ledger"}, {"entries", entries}};
  return json.dump(1) + "\n";
}

}  // namespace helicoid
