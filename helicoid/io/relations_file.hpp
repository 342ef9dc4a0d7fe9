// Known relative poses to score against (Kuemmerle et al. 2009): `t1 t2 x y z roll pitch yaw`, or between robots
// `robot_a t_a robot_b t_b x y yaw`.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "helicoid/base/result.hpp"
#include "helicoid/geometry/pose2.hpp"
#include "helicoid/io/skipped.hpp"

namespace helicoid {

/// The pose of robot b at time b in the frame of robot a at time a. Names are empty where the file has none.
struct TrueRelation {
  std::string robot_a;
  double stamp_a = 0;
  std::string robot_b;
  double stamp_b = 0;
  Pose2 T_a_b;
};

struct RelationsFile {
  std::vector<TrueRelation> relations;
  std::vector<Skipped> skipped;
};
[[nodiscard]] Result<RelationsFile> read_relations(const std::string& path);
[[nodiscard]] RelationsFile parse_relations(const std::string& text, const std::string& name);
/// The format between robots, with a heading comment.
[[nodiscard]] std::string to_relations_text(std::span<const TrueRelation> relations);
/// The format of one robot, which names none: `t1 t2 x y z roll pitch yaw`.
[[nodiscard]] std::string to_single_robot_relations_text(std::span<const TrueRelation> relations);

}  // namespace helicoid
