// Known relations of a file, as the relation error takes them.
#pragma once

#include <string>
#include <vector>

#include "helicoid/base/result.hpp"
#include "helicoid/eval/relation_error.hpp"
#include "helicoid/io/relations_file.hpp"

namespace helicoid {

[[nodiscard]] std::vector<EvaluatedRelation> to_evaluate(const RelationsFile& file);
/// Errors: as read_relations.
[[nodiscard]] Result<std::vector<EvaluatedRelation>> read_evaluated(const std::string& path);

}  // namespace helicoid
