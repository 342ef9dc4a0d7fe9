#include "apps/evaluated_relations.hpp"

namespace helicoid {

std::vector<EvaluatedRelation> to_evaluate(const RelationsFile& file) {
  std::vector<EvaluatedRelation> relations;
  relations.reserve(file.relations.size());
  for (const TrueRelation& r : file.relations) {
    relations.push_back({r.robot_a, r.stamp_a, r.robot_b, r.stamp_b, r.T_a_b});
  }
  return relations;
}

Result<std::vector<EvaluatedRelation>> read_evaluated(const std::string& path) {
  const Result<RelationsFile> file = read_relations(path);
  if (!file) return tl::unexpected(file.error());
  return to_evaluate(*file);
}

}  // namespace helicoid
