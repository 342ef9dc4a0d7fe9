// Fits a g2o graph by Ceres at its best setting and prints cost, CPU seconds and iterations: the baseline of
// `helicoid bench --filter fit` and of `helicoid experiment mrclam`, in a process of its own so that the program need
// not carry Ceres. A second argument names the file for the fitted graph.
#include <ceres/ceres.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <cstdio>
#include <ctime>

#include "helicoid/base/whole_file.hpp"
#include "helicoid/io/graph_reader.hpp"

namespace {

using namespace helicoid;

/// A square root U of a positive semi-definite information: U^T U. Cholesky's needs a definite one.
Matrix3d root_of(const Matrix3d& information) {
  const Eigen::LLT<Matrix3d> cholesky(information);
  if (cholesky.info() == Eigen::Success) return cholesky.matrixU();
  const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(information);
  return eigen.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal() * eigen.eigenvectors().transpose();
}

/// Residual L^T (measured^-1 T_a_b) with the exact derivatives by (x, y, yaw) of both ends.
class PosePoseCost : public ceres::SizedCostFunction<3, 3, 3> {
 public:
  explicit PosePoseCost(const PosePose& m) : m_(m), root_(root_of(m.information)) {}
  bool Evaluate(double const* const* p, double* residuals, double** jacobians) const override {
    const double* a = p[0];
    const double* b = p[1];
    const double dx = b[0] - a[0];
    const double dy = b[1] - a[1];
    const double heading = a[2] + m_.T_a_b.yaw;
    const double c = std::cos(heading);
    const double s = std::sin(heading);
    const Pose2& m = m_.T_a_b;
    const double cm = std::cos(m.yaw);
    const double sm = std::sin(m.yaw);
    const Vector3d e(c * dx + s * dy - cm * m.x - sm * m.y, c * dy - s * dx - cm * m.y + sm * m.x,
                     wrap_angle(b[2] - a[2] - m.yaw));
    Eigen::Map<Vector3d>(residuals, 3) = root_ * e;
    using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
    if (jacobians == nullptr) return true;
    Matrix3d J;
    J << c, s, 0, -s, c, 0, 0, 0, 1;
    if (jacobians[1] != nullptr) Eigen::Map<RowMajor>(jacobians[1], 3, 3) = root_ * J;
    J = -J;
    J(0, 2) = c * dy - s * dx;
    J(1, 2) = -c * dx - s * dy;
    if (jacobians[0] != nullptr) Eigen::Map<RowMajor>(jacobians[0], 3, 3) = root_ * J;
    return true;
  }

 private:
  PosePose m_;
  Matrix3d root_;
};

/// Residual L^T (R_a^T (t_b - t_a) - p_a) with its exact derivatives by a's (x, y, yaw) and b's (x, y).
class PointCost : public ceres::SizedCostFunction<2, 3, 2> {
 public:
  explicit PointCost(const PointPosition& m) : m_(m), root_(Eigen::LLT<Matrix2d>(m.information).matrixU()) {}
  bool Evaluate(double const* const* p, double* residuals, double** jacobians) const override {
    const double* a = p[0];
    const double dx = p[1][0] - a[0];
    const double dy = p[1][1] - a[1];
    const double c = std::cos(a[2]);
    const double s = std::sin(a[2]);
    const Vector2d e(c * dx + s * dy - m_.p_a.x(), c * dy - s * dx - m_.p_a.y());
    Eigen::Map<Vector2d>(residuals, 2) = root_ * e;
    if (jacobians == nullptr) return true;
    Eigen::Matrix<double, 2, 3, Eigen::RowMajor> J;
    J << -c, -s, c * dy - s * dx, s, -c, -c * dx - s * dy;
    if (jacobians[0] != nullptr)
      Eigen::Map<Eigen::Matrix<double, 2, 3, Eigen::RowMajor>>(jacobians[0], 2, 3) = root_ * J;
    using RowMajor = Eigen::Matrix<double, 2, 2, Eigen::RowMajor>;
    if (jacobians[1] != nullptr) Eigen::Map<RowMajor>(jacobians[1], 2, 2) = -root_ * J.leftCols<2>();
    return true;
  }

 private:
  PointPosition m_;
  Matrix2d root_;
};

void add(const GraphRelation& r, std::vector<Vector3d>& poses, ceres::Problem& problem) {
  double* a = poses[r.a].data();
  double* b = poses[r.b].data();
  if (const auto* pose = std::get_if<PosePose>(&r.measurement)) {
    problem.AddResidualBlock(new PosePoseCost(*pose), nullptr, a, b);
  } else {
    problem.AddResidualBlock(new PointCost(std::get<PointPosition>(r.measurement)), nullptr, a, b);
  }
}

double cpu_seconds() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2 && argc != 3) return 2;
  const Result<GraphFile> file = read_graph(argv[1]);
  if (!file) {
    std::fprintf(stderr, "%s\n", file.error().message.c_str());
    return 1;
  }
  std::vector<Vector3d> poses;
  for (const Pose2& T : file->graph.poses) poses.push_back(T.vector());
  const double began = cpu_seconds();
  ceres::Problem problem;
  for (const GraphRelation& r : file->graph.relations) add(r, poses, problem);
  for (const std::uint32_t node : default_gauge(file->graph)) problem.SetParameterBlockConstant(poses[node].data());
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.initial_trust_region_radius = 1e16;  // near Gauss-Newton
  options.max_trust_region_radius = 1e32;
  options.function_tolerance = 1e-7;
  options.max_num_iterations = 200;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  std::printf("%.12g %.6f %zu\n", 2 * summary.final_cost, cpu_seconds() - began, summary.iterations.size() - 1);
  if (argc < 3) return 0;
  std::vector<Pose2> fitted;
  fitted.reserve(poses.size());
  for (const Vector3d& p : poses) fitted.push_back(Pose2::from_vector(p));
  return write_whole_file(argv[2], to_graph_text(*file, fitted)) ? 0 : 1;
}
