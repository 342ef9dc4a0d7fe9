#include <fmt/compile.h>

#include <iterator>

#include "helicoid/io/graph_reader.hpp"

namespace helicoid {

namespace {

using Out = std::back_insert_iterator<std::string>;

struct WriteMeasurement {
  Out out;
  std::int64_t a;
  std::int64_t b;
  bool to_world;
  bool toro;

  void operator()(const PosePose& m) const {
    const Matrix3d& I = m.information;
    const Pose2& T = m.T_a_b;
    if (to_world) {
      fmt::format_to(out, "EDGE_PRIOR_SE2 {} {:.9g} {:.9g} {:.12g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g}\n", b, T.x,
                     T.y, T.yaw, I(0, 0), I(0, 1), I(0, 2), I(1, 1), I(1, 2), I(2, 2));
    } else if (toro) {
      fmt::format_to(out, "EDGE2 {} {} {:.9g} {:.9g} {:.12g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g}\n", a, b, T.x,
                     T.y, T.yaw, I(0, 0), I(0, 1), I(1, 1), I(2, 2), I(0, 2), I(1, 2));
    } else {
      fmt::format_to(out,
                     FMT_COMPILE("EDGE_SE2 {} {} {:.9g} {:.9g} {:.12g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g}\n"), a,
                     b, T.x, T.y, T.yaw, I(0, 0), I(0, 1), I(0, 2), I(1, 1), I(1, 2), I(2, 2));
    }
  }
  void operator()(const PointPosition& m) const {
    fmt::format_to(out, "EDGE_SE2_XY {} {} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g}\n", a, b, m.p_a.x(), m.p_a.y(),
                   m.information(0, 0), m.information(0, 1), m.information(1, 1));
  }
  void operator()(const RelativeBearing& m) const {
    fmt::format_to(out, "EDGE_BEARING_SE2_XY {} {} {:.12g} {:.9g}\n", a, b, m.bearing, 1 / (m.sigma * m.sigma));
  }
  // No graph that was read holds these.
  void operator()(const Correspondences&) const {}
  void operator()(const RelativeRange&) const {}
};

}  // namespace

std::string to_graph_text(const GraphFile& file, const std::vector<Pose2>& poses) {
  std::string text;
  text.reserve(64 * poses.size() + 128 * file.graph.relations.size());
  const Out out(text);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Pose2& T = poses[i];
    if (!file.graph.is_landmark.empty() && file.graph.is_landmark[i]) {
      fmt::format_to(out, "VERTEX_XY {} {:.9f} {:.9f}\n", file.ids[i], T.x, T.y);
    } else {
      fmt::format_to(out, FMT_COMPILE("{} {} {:.9f} {:.9f} {:.12f}\n"), file.is_toro ? "VERTEX2" : "VERTEX_SE2",
                     file.ids[i], T.x, T.y, T.yaw);
    }
  }
  for (const std::uint32_t node : file.fixed) fmt::format_to(out, "FIX {}\n", file.ids[node]);
  for (const GraphRelation& r : file.graph.relations) {
    const bool to_world = r.a == kWorld;
    std::visit(WriteMeasurement{out, to_world ? -1 : file.ids[r.a], file.ids[r.b], to_world, file.is_toro},
               r.measurement);
  }
  return text;
}

}  // namespace helicoid
