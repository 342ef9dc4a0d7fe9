#include "helicoid/io/graph_file.hpp"

#include <fmt/compile.h>

#include <iterator>

#include "helicoid/manifold/confidence.hpp"

namespace helicoid {

std::string to_g2o(const Map& map) {
  std::string text;
  text.reserve(160 * (map.patch_count() + map.relations().size()));
  auto out = std::back_inserter(text);
  for (std::size_t i = 0; i < map.patch_count(); ++i) {
    const Pose2& T = map.T_plane_patch(make_id<PatchId>(i));
    fmt::format_to(out, FMT_COMPILE("VERTEX_SE2 {} {:.6f} {:.6f} {:.8f}\n"), i, T.x, T.y, T.yaw);
  }
  for (const Island& island : map.islands()) fmt::format_to(out, "FIX {}\n", island.patches.front().value);
  for (const Relation& r : map.relations()) {
    const PairExpansion e = expand(r.form, r.T_a_b);
    const Matrix3d I = e.information / information_divisor(map, r);
    fmt::format_to(out, FMT_COMPILE("EDGE_SE2 {} {} {:.6f} {:.6f} {:.8f} {:.6g} {:.6g} {:.6g} {:.6g} {:.6g} {:.6g}\n"),
                   r.a.value, r.b.value, r.T_a_b.x, r.T_a_b.y, r.T_a_b.yaw, I(0, 0), I(0, 1), I(0, 2), I(1, 1), I(1, 2),
                   I(2, 2));
  }
  return text;
}

}  // namespace helicoid
