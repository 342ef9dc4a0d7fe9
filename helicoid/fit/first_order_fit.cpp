#include "helicoid/fit/first_order_fit.hpp"

#include <Eigen/Cholesky>
#include <cmath>

#include "helicoid/fit/cpu_clock.hpp"

namespace helicoid {

namespace {

double dot(std::span<const double> a, std::span<const double> b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

/// -D^-1 gradient, with D the diagonal blocks.
std::vector<double> preconditioned(const LinearSystem& system) {
  const auto gradient = system.gradient();
  std::vector<double> direction(gradient.size());
  for (std::size_t k = 0; 3 * k < gradient.size(); ++k) {
    const Eigen::Map<const Matrix3d> block(system.information().diagonal.data() + 9 * k);
    const Matrix3d safe = block + 1e-9 * (1 + block.trace()) * Matrix3d::Identity();
    Eigen::Map<Vector3d>(direction.data() + 3 * k) = -safe.llt().solve(Eigen::Map<const Vector3d>(gradient.data() + 3 * k));
  }
  return direction;
}

/// direction^T H direction: the curvature along it.
double curvature(const BlockMatrix& H, std::span<const double> direction) {
  double sum = 0;
  for (std::size_t k = 0; 3 * k < direction.size(); ++k) {
    const Eigen::Map<const Vector3d> x(direction.data() + 3 * k);
    sum += x.dot(Eigen::Map<const Matrix3d>(H.diagonal.data() + 9 * k) * x);
    for (std::size_t e = H.first[k]; e < H.first[k + 1]; ++e) {
      const Eigen::Map<const Vector3d> y(direction.data() + 3 * H.row[e]);
      sum += 2 * y.dot(Eigen::Map<const Matrix3d>(H.below.data() + 9 * e) * x);
    }
  }
  return sum;
}

}  // namespace

void descend(LinearSystem& system, const FitOptions& options, FitResult& result) {
  constexpr int kPatience = 1000;  // first-order iterations for one of second order
  const CpuTimer timer(result.times.linearise_s);
  double current = system.linearise(result.poses, options.loss);
  result.initial_cost = result.final_cost = current;
  result.status = FitStatus::iteration_limit;
  std::vector<double> direction;
  double last_product = 0;
  for (; result.iterations < kPatience * options.max_iterations; ++result.iterations) {
    std::vector<double> descent = preconditioned(system);
    const double product = -dot(system.gradient(), descent);
    result.gradient_norm = std::sqrt(dot(system.gradient(), system.gradient()));
    // Per unknown far below what second order asks of the whole: slow methods creep, and must not stop on the way.
    if (product <= 1e-6 * options.relative_tolerance * current) {
      result.status = FitStatus::converged;
      break;
    }
    const bool conjugate = options.method == FitMethod::fletcher_reeves && !direction.empty();
    const double beta = conjugate ? product / last_product : 0;
    direction.resize(descent.size());
    for (std::size_t i = 0; i < descent.size(); ++i) direction[i] = descent[i] + beta * direction[i];
    double slope = dot(system.gradient(), direction);
    if (slope >= 0) {
      direction = std::move(descent);
      slope = -product;
    }
    last_product = product;
    // The minimum along the line of the quadratic model; shorter while that does not lower the cost enough.
    double length = -slope / curvature(system.information(), direction);
    std::vector<Pose2> next = system.moved(result.poses, direction, length);
    double cost = system.cost(next, options.loss);
    int halvings = 0;
    for (; cost > current + 1e-4 * length * slope && halvings < 40; ++halvings) {
      length *= 0.5;
      next = system.moved(result.poses, direction, length);
      cost = system.cost(next, options.loss);
    }
    if (cost > current || halvings == 40) {
      result.status = FitStatus::converged;
      break;
    }
    if (halvings > 0) direction.clear();
    result.poses = std::move(next);
    result.final_cost = current = system.linearise(result.poses, options.loss);
  }
}

}  // namespace helicoid
