// Whatever a relations file holds, each line becomes a relation or is counted; relations survive being written.
#include <cstdint>
#include <cstdlib>

#include "helicoid/io/relations_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace helicoid;
  const RelationsFile file = parse_relations(std::string(reinterpret_cast<const char*>(data), size), "fuzz");
  std::size_t named = 0;
  for (const TrueRelation& r : file.relations) named += r.robot_a.empty() || r.robot_a[0] == '#' ? 0 : 1;
  if (named != file.relations.size()) return 0;
  const RelationsFile again = parse_relations(to_relations_text(file.relations), "again");
  if (again.relations.size() != file.relations.size()) std::abort();
  return 0;
}
