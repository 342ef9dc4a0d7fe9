#include "helicoid/exploration/edge_clusters.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "helicoid/exploration/ground_window.hpp"

namespace helicoid {

namespace {

/// Disjoint sets of points.
class Chains {
 public:
  explicit Chains(std::size_t size) : parent_(size) { std::iota(parent_.begin(), parent_.end(), std::size_t{0}); }
  std::size_t root(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  /// The lower number stands for both.
  void join(std::size_t a, std::size_t b) {
    a = root(a);
    b = root(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::size_t> parent_;
};

std::vector<EdgePoint> open_points(const Map& map, const OpenEdges& edges) {
  std::vector<EdgePoint> points;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const auto id = make_id<PatchId>(i);
    if (edges.of(id).empty()) continue;
    const Pose2& T_plane_patch = map.T_plane_patch(id);
    const Matrix2d R = T_plane_patch.rotation();
    for (const OpenPoint& point : edges.of(id)) {
      points.push_back(
          {id, R * point.p_patch.cast<double>() + T_plane_patch.translation(), R * point.outward_patch.cast<double>()});
    }
  }
  return points;
}

struct Square {
  IslandId island;
  std::int32_t row, column;
  friend auto operator<=>(const Square&, const Square&) = default;
};

/// Points of one sheet that lie within reach of each other are one chain.
Chains link(const Map& map, const OpenEdges& edges, std::span<const EdgePoint> points, double reach) {
  const auto square_of = [&](const EdgePoint& p) {
    return Square{map.island_of(p.patch), static_cast<std::int32_t>(std::floor(p.p_plane.y() / reach)),
                  static_cast<std::int32_t>(std::floor(p.p_plane.x() / reach))};
  };
  std::map<Square, std::vector<std::size_t>> squares;
  for (std::size_t i = 0; i < points.size(); ++i) squares[square_of(points[i])].push_back(i);
  Chains chains(points.size());
  for (const auto& [square, inside] : squares) {
    for (std::int32_t r = -1; r <= 1; ++r) {
      for (std::int32_t c = -1; c <= 1; ++c) {
        const auto other = squares.find({square.island, square.row + r, square.column + c});
        if (other == squares.end()) continue;
        for (const std::size_t i : inside) {
          for (const std::size_t k : other->second) {
            if (k <= i || (points[i].p_plane - points[k].p_plane).norm() > reach) continue;
            if (edges.same_sheet(points[i].patch, points[k].patch)) chains.join(i, k);
          }
        }
      }
    }
  }
  return chains;
}

EdgeCluster summed_up(const Map& map, std::vector<EdgePoint> points) {
  EdgeCluster cluster;
  cluster.island = map.island_of(points.front().patch);
  std::set<GroundCell> cells;
  for (const EdgePoint& point : points) {
    cells.insert(ground_cell(point.p_plane));
    cluster.middle_plane += point.p_plane / static_cast<double>(points.size());
    cluster.outward_plane += point.outward_plane / static_cast<double>(points.size());
  }
  cluster.length = kGroundCell * static_cast<double>(cells.size());
  cluster.points = std::move(points);
  return cluster;
}

/// Cuts a long chain across the direction in which it spreads most.
std::vector<std::vector<EdgePoint>> cut(const std::vector<EdgePoint>& points, double longest) {
  Vector2d middle = Vector2d::Zero();
  for (const EdgePoint& p : points) middle += p.p_plane / static_cast<double>(points.size());
  Matrix2d spread = Matrix2d::Zero();
  for (const EdgePoint& p : points) spread += (p.p_plane - middle) * (p.p_plane - middle).transpose();
  const double angle = 0.5 * std::atan2(2 * spread(0, 1), spread(0, 0) - spread(1, 1));
  const Vector2d along(std::cos(angle), std::sin(angle));
  double low = 0;
  double high = 0;
  for (const EdgePoint& p : points) {
    low = std::min(low, along.dot(p.p_plane - middle));
    high = std::max(high, along.dot(p.p_plane - middle));
  }
  const auto parts = static_cast<std::size_t>(std::max(1.0, std::ceil((high - low) / longest)));
  std::vector<std::vector<EdgePoint>> pieces(parts);
  for (const EdgePoint& p : points) {
    const double share = (along.dot(p.p_plane - middle) - low) / std::max(1e-9, high - low);
    pieces[std::min(parts - 1, static_cast<std::size_t>(share * static_cast<double>(parts)))].push_back(p);
  }
  return pieces;
}

}  // namespace

std::vector<EdgeCluster> cluster_edges(const Map& map, const OpenEdges& edges, const ClusterOptions& options) {
  const std::vector<EdgePoint> points = open_points(map, edges);
  Chains chains = link(map, edges, points, options.link);
  std::map<std::size_t, std::vector<EdgePoint>> by_root;
  for (std::size_t i = 0; i < points.size(); ++i) by_root[chains.root(i)].push_back(points[i]);
  std::vector<EdgeCluster> clusters;
  for (const auto& [root, chain] : by_root) {
    for (std::vector<EdgePoint>& piece : cut(chain, options.longest)) {
      if (piece.empty()) continue;
      EdgeCluster cluster = summed_up(map, std::move(piece));
      if (cluster.length >= options.shortest) clusters.push_back(std::move(cluster));
    }
  }
  return clusters;
}

}  // namespace helicoid
