#include "helicoid/fit/first_order_fit.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
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
    Eigen::Map<Vector3d>(direction.data() + 3 * k) =
        -safe.llt().solve(Eigen::Map<const Vector3d>(gradient.data() + 3 * k));
  }
  return direction;
}

/// Preconditioned descent along one direction after another.
class Descent {
 public:
  Descent(LinearSystem& system, const FitOptions& options, FitResult& result)
      : system_(system), options_(options), result_(result) {}

  void run() {
    constexpr int kPatience = 1000;  // first-order iterations for one of second order
    relinearise();
    result_.initial_cost = result_.final_cost;
    result_.status = FitStatus::iteration_limit;
    while (result_.iterations < kPatience * options_.max_iterations) {
      ++result_.iterations;
      std::vector<double> descent = preconditioned(system_);
      product_ = -dot(system_.gradient(), descent);
      // Slow methods creep: what is left to gain is many times what the next step gains.
      if (product_ <= 1e-6 * options_.relative_tolerance * result_.final_cost || !step(std::move(descent))) {
        result_.status = FitStatus::converged;
        return;
      }
      if (options_.progress) options_.progress(result_.iterations, result_.final_cost);
    }
  }

 private:
  void relinearise() {
    result_.final_cost = system_.linearise(result_.poses, options_.loss);
    result_.gradient_norm = std::sqrt(dot(system_.gradient(), system_.gradient()));
  }

  /// Fletcher and Reeves 1964: conjugate to the last direction, unless that leads uphill.
  void turn_conjugate(std::vector<double> descent) {
    const double beta = direction_.empty() ? 0 : product_ / last_product_;
    direction_.resize(descent.size(), 0.0);
    for (std::size_t i = 0; i < descent.size(); ++i) direction_[i] = descent[i] + beta * direction_[i];
    if (dot(system_.gradient(), direction_) >= 0) direction_ = std::move(descent);
  }

  /// The minimum of the quadratic model along the direction; for gradient descent that of the step before (Barzilai and
  /// Borwein 1988), which zigzags far less.
  [[nodiscard]] double first_length() const {
    if (options_.method == FitMethod::gradient_descent && last_length_ > 0) {
      const double turned = last_product_ + last_slope_;
      if (turned > 1e-12 * last_product_) return std::min(1e3, last_length_ * last_product_ / turned);
    }
    return -dot(system_.gradient(), direction_) / dot(direction_, multiply(system_.information(), direction_));
  }

  /// Costs may rise for some steps as long as the last ten stay below (Grippo, Lampariello and Lucidi 1986); conjugate
  /// directions must not.
  [[nodiscard]] double allowed_cost() const {
    return recent_.empty() ? result_.final_cost : *std::max_element(recent_.begin(), recent_.end());
  }

  bool step(std::vector<double> descent) {
    const bool conjugate = options_.method == FitMethod::fletcher_reeves;
    // d . g of the step before, with the gradient of now: what Barzilai and Borwein's length needs.
    last_slope_ = direction_.empty() ? 0 : dot(system_.gradient(), direction_);
    if (conjugate) {
      turn_conjugate(std::move(descent));
    } else {
      direction_ = std::move(descent);
    }
    const double slope = dot(system_.gradient(), direction_);
    double length = first_length();
    const double allowed = conjugate ? result_.final_cost : allowed_cost();
    std::vector<Pose2> next = system_.moved(result_.poses, direction_, length);
    int halvings = 0;
    while (!(system_.cost(next, options_.loss) <= allowed + 1e-4 * length * slope)) {
      if (++halvings == 40) return false;
      length *= 0.5;
      next = system_.moved(result_.poses, direction_, length);
    }
    last_product_ = product_;
    last_length_ = length;
    result_.poses = std::move(next);
    relinearise();
    recent_.push_back(result_.final_cost);
    if (recent_.size() > 10) recent_.erase(recent_.begin());
    if (conjugate && halvings > 0) direction_.clear();
    return true;
  }

  LinearSystem& system_;
  const FitOptions& options_;
  FitResult& result_;
  std::vector<double> direction_;
  std::vector<double> recent_;
  double product_ = 0;  ///< gradient . D^-1 gradient
  double last_product_ = 0;
  double last_slope_ = 0;
  double last_length_ = 0;
};

}  // namespace

void descend(LinearSystem& system, const FitOptions& options, FitResult& result) {
  const CpuTimer timer(result.times.linearise_s);
  Descent(system, options, result).run();
}

}  // namespace helicoid
