// The geometry of SVG attributes: lists of numbers, transforms, paths of straight lines.
#pragma once

#include <Eigen/Core>
#include <string_view>
#include <vector>

#include "helicoid/geometry/pose2.hpp"

namespace helicoid {

/// A poly-line of a path; closed if it ends in Z.
struct SvgLine {
  std::vector<Vector2d> points;
  bool closed = false;
};

/// An affine map of the plane, row major: x' = a x + c y + e; y' = b x + d y + f.
struct SvgTransform {
  Eigen::Matrix<double, 2, 3> M = (Eigen::Matrix<double, 2, 3>() << 1, 0, 0, 0, 1, 0).finished();
  [[nodiscard]] Vector2d operator()(const Vector2d& p) const { return M.leftCols<2>() * p + M.col(2); }
  [[nodiscard]] SvgTransform then_inner(const SvgTransform& inner) const;
};

/// Numbers separated by blanks and commas; stops at what is none.
[[nodiscard]] std::vector<double> svg_numbers(std::string_view text);
/// translate, scale, rotate and matrix, in sequence; others are taken for the identity.
[[nodiscard]] SvgTransform svg_transform(std::string_view text);
/// M, L, H, V and Z, absolute and relative; curves are replaced by their chord.
[[nodiscard]] std::vector<SvgLine> svg_path(std::string_view text);

}  // namespace helicoid
