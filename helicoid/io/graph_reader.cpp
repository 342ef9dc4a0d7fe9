#include "helicoid/io/graph_reader.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>

#include "helicoid/io/number.hpp"
#include "helicoid/io/text_file.hpp"

namespace helicoid {

namespace {

constexpr double kLargestId = 9007199254740992;  // 2^53: beyond, a double does not tell neighbours apart

struct Vertex {
  std::int64_t id = 0;
  Pose2 pose;
  bool is_landmark = false;
};

/// A relation that still names its nodes by their ids.
struct NamedRelation {
  std::int64_t a = 0;  ///< -1: the world
  std::int64_t b = 0;
  Measurement measurement;
  bool b_is_landmark = false;
  std::size_t line = 0;
};

bool is_semidefinite(const Matrix3d& m) {
  const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(m, Eigen::EigenvaluesOnly);
  return solver.eigenvalues()[0] >= -1e-9 * std::max(1e-300, solver.eigenvalues()[2]);
}

Matrix3d symmetric(double xx, double xy, double xt, double yy, double yt, double tt) {
  Matrix3d m;
  m << xx, xy, xt, xy, yy, yt, xt, yt, tt;
  return m;
}

class GraphParser {
 public:
  GraphParser(const std::string& text, const std::string& name) : text_(text), name_(name) {}

  GraphFile parse() {
    for (std::size_t begin = 0; begin < text_.size();) {
      ++line_;
      const std::size_t end = std::min(text_.find('\n', begin), text_.size());
      cursor_ = {text_.data() + begin, text_.data() + end};
      begin = end + 1;
      parse_line();
    }
    return gather();
  }

 private:
  void skip(const char* reason) {
    skipped_.add(reason, [&] { return fmt::format("{}:{}", name_, line_); });
  }

  /// The next N numbers of the line, all finite.
  template <std::size_t N>
  std::optional<std::array<double, N>> numbers() {
    std::array<double, N> values{};
    for (double& value : values) {
      const ReadNumber number = read_number(cursor_);
      if (!number.ok || !std::isfinite(number.value) || std::abs(number.value) > 1e100) return std::nullopt;
      value = number.value;
    }
    return values;
  }

  /// The next N numbers as ids.
  template <std::size_t N>
  std::optional<std::array<std::int64_t, N>> ids() {
    const auto values = numbers<N>();
    std::array<std::int64_t, N> result{};
    if (!values) return std::nullopt;
    for (std::size_t i = 0; i < N; ++i) {
      const double value = (*values)[i];
      if (value < 0 || value > kLargestId || value != std::floor(value)) return std::nullopt;
      result[i] = static_cast<std::int64_t>(value);
    }
    return result;
  }

  void parse_line() {
    cursor_.skip_blanks();
    const char* begin = cursor_.at;
    while (cursor_.at != cursor_.end && *cursor_.at != ' ' && *cursor_.at != '\t' && *cursor_.at != '\r') ++cursor_.at;
    const std::string_view tag(begin, static_cast<std::size_t>(cursor_.at - begin));
    if (tag.empty() || tag[0] == '#') return;
    bool ok = true;
    if (tag == "VERTEX_SE2" || tag == "VERTEX2") {
      ok = vertex();
    } else if (tag == "VERTEX_XY") {
      ok = landmark();
    } else if (tag == "EDGE_SE2" || tag == "EDGE2") {
      ok = edge(tag == "EDGE2");
    } else if (tag == "EDGE_PRIOR_SE2") {
      ok = prior();
    } else if (tag == "EDGE_SE2_XY") {
      ok = point();
    } else if (tag == "EDGE_BEARING_SE2_XY") {
      ok = bearing();
    } else if (tag == "FIX") {
      const auto id = ids<1>();
      ok = id.has_value();
      if (ok) fixed_.push_back((*id)[0]);
    } else {
      skip("line of a kind that is not known");
    }
    if (!ok) skip("line with numbers that are missing, not finite or no ids");
  }

  bool vertex() {
    const auto id = ids<1>();
    const auto v = numbers<3>();
    if (id && v) vertices_.push_back({(*id)[0], Pose2{(*v)[0], (*v)[1], wrap_angle((*v)[2])}, false});
    return id && v;
  }

  bool landmark() {
    const auto id = ids<1>();
    const auto v = numbers<2>();
    if (id && v) vertices_.push_back({(*id)[0], Pose2{(*v)[0], (*v)[1], 0}, true});
    return id && v;
  }

  void add(std::int64_t a, std::int64_t b, Measurement measurement, const Matrix3d& information, bool b_is_landmark) {
    if (a == b) {
      skip("relation of a node with itself");
    } else if (!is_semidefinite(information)) {
      skip("relation whose information is not positive semi-definite");
    } else {
      relations_.push_back({a, b, std::move(measurement), b_is_landmark, line_});
    }
  }

  bool edge(bool toro) {
    const auto id = ids<2>();
    const auto v = numbers<9>();
    if (!id || !v) return false;
    is_toro_ = is_toro_ || toro;
    const auto& n = *v;
    const Matrix3d information =
        toro ? symmetric(n[3], n[4], n[7], n[5], n[8], n[6]) : symmetric(n[3], n[4], n[5], n[6], n[7], n[8]);
    add((*id)[0], (*id)[1], PosePose{{n[0], n[1], wrap_angle(n[2])}, information}, information, false);
    return true;
  }

  bool prior() {
    const auto id = ids<1>();
    const auto v = numbers<9>();
    if (!id || !v) return false;
    const auto& n = *v;
    const Matrix3d information = symmetric(n[3], n[4], n[5], n[6], n[7], n[8]);
    add(-1, (*id)[0], PosePose{{n[0], n[1], wrap_angle(n[2])}, information}, information, false);
    return true;
  }

  bool point() {
    const auto id = ids<2>();
    const auto v = numbers<5>();
    if (!id || !v) return false;
    const auto& n = *v;
    const Matrix3d information = symmetric(n[2], n[3], 0, n[4], 0, 0);
    add((*id)[0], (*id)[1], PointPosition{{n[0], n[1]}, information.topLeftCorner<2, 2>()}, information, true);
    return true;
  }

  bool bearing() {
    const auto id = ids<2>();
    const auto v = numbers<2>();
    if (!id || !v) return false;
    RelativeBearing m;
    m.bearing = (*v)[0];
    m.sigma = (*v)[1] > 0 ? 1 / std::sqrt((*v)[1]) : 1;
    add((*id)[0], (*id)[1], m, symmetric((*v)[1], 0, 0, 0, 0, 0), true);
    return true;
  }

  [[nodiscard]] std::int64_t index_of(const GraphFile& file, std::int64_t id) const {
    return std::lower_bound(file.ids.begin(), file.ids.end(), id) - file.ids.begin();
  }

  GraphFile gather() {
    GraphFile file;
    for (const Vertex& v : vertices_) file.ids.push_back(v.id);
    for (const NamedRelation& r : relations_) {
      if (r.a >= 0) file.ids.push_back(r.a);
      file.ids.push_back(r.b);
    }
    std::sort(file.ids.begin(), file.ids.end());
    file.ids.erase(std::unique(file.ids.begin(), file.ids.end()), file.ids.end());
    place_vertices(file);
    take_relations(file);
    for (const std::int64_t id : fixed_) {
      const auto at = static_cast<std::size_t>(index_of(file, id));
      if (at < file.ids.size() && file.ids[at] == id) file.fixed.push_back(static_cast<std::uint32_t>(at));
    }
    file.is_toro = is_toro_;
    file.skipped = skipped_.all();
    return file;
  }

  void place_vertices(GraphFile& file) {
    file.graph.poses.resize(file.ids.size());
    file.is_placed.assign(file.ids.size(), false);
    std::vector<bool> is_landmark(file.ids.size(), false);
    for (const NamedRelation& r : relations_) {
      if (r.b_is_landmark) is_landmark[static_cast<std::size_t>(index_of(file, r.b))] = true;
    }
    for (const Vertex& v : vertices_) {
      const auto at = static_cast<std::size_t>(index_of(file, v.id));
      if (file.is_placed[at]) {
        skip("vertex that was there before");
        continue;
      }
      file.is_placed[at] = true;
      file.graph.poses[at] = v.pose;
      is_landmark[at] = v.is_landmark;
    }
    if (std::find(is_landmark.begin(), is_landmark.end(), true) != is_landmark.end())
      file.graph.is_landmark = is_landmark;
  }

  void take_relations(GraphFile& file) {
    file.graph.relations.reserve(relations_.size());
    const auto& landmark = file.graph.is_landmark;
    for (NamedRelation& r : relations_) {
      const std::uint32_t a = r.a < 0 ? kWorld : static_cast<std::uint32_t>(index_of(file, r.a));
      const auto b = static_cast<std::uint32_t>(index_of(file, r.b));
      line_ = r.line;
      const bool a_is_landmark = a != kWorld && !landmark.empty() && landmark[a];
      const bool b_is_landmark = !landmark.empty() && landmark[b];
      if (a_is_landmark || b_is_landmark != r.b_is_landmark) {
        skip("relation between a pose and a landmark that needs another kind of node");
        continue;
      }
      // Consecutive ids are a robot's own chain; what joins others may be wrong.
      const bool chain = a != kWorld && r.b == r.a + 1;
      file.graph.relations.push_back({a, b, std::move(r.measurement), a != kWorld && !chain && !b_is_landmark});
    }
  }

  const std::string& text_;
  const std::string& name_;
  TextCursor cursor_;
  std::size_t line_ = 0;
  std::vector<Vertex> vertices_;
  std::vector<NamedRelation> relations_;
  std::vector<std::int64_t> fixed_;
  bool is_toro_ = false;
  SkipCounter skipped_;
};

}  // namespace

GraphFile parse_graph(const std::string& text, const std::string& name) {
  return GraphParser(text, name).parse();
}

Result<GraphFile> read_graph(const std::string& path) {
  const Result<TextFile> text = read_text_file(path);
  if (!text) return tl::unexpected(text.error());
  if (looks_binary(text->text)) return fail("{}: is binary; a g2o or TORO graph is a text", path);
  GraphFile file = parse_graph(text->text, text->name);
  file.warning = text->warning;
  if (file.graph.relations.empty()) {
    std::string why;
    for (const Skipped& s : file.skipped) why += fmt::format("; {} x {}, first at {}", s.count, s.reason, s.first);
    return fail(
        "{}: holds no relation; a g2o graph has lines `EDGE_SE2 a b x y yaw` and the upper half of the "
        "information{}",
        path, why);
  }
  return file;
}

}  // namespace helicoid
