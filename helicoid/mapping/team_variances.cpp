#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "helicoid/fit/linear_system.hpp"
#include "helicoid/geometry/covariance.hpp"
#include "helicoid/mapping/team_calibration.hpp"

namespace helicoid {

namespace {

/// A squared residual whose variance is first * u.x + second * u.y.
struct SquaredResidual {
  Vector2d u;
  double square = 0;
};

/// The two shares of a variance, by likelihood: weighted least squares on the squares, again and again. Neither is less
/// than `least`.
Vector2d fit_shares(std::span<const SquaredResidual> residuals, Vector2d shares, double least) {
  for (int round = 0; round < 20 && residuals.size() >= 20; ++round) {
    Matrix2d A = Matrix2d::Zero();
    Vector2d right = Vector2d::Zero();
    for (const SquaredResidual& r : residuals) {
      const double weight = std::pow(shares.dot(r.u), -2);
      A += weight * r.u * r.u.transpose();
      right += weight * r.square * r.u;
    }
    shares = A.determinant() > 1e-9 * A(0, 0) * A(1, 1) ? Vector2d(A.inverse() * right) : Vector2d(least, -1);
    // Where one of the two would be less the other explains all alone.
    if (shares.y() < least) shares = {A(0, 0) > 0 ? right.x() / A(0, 0) : least, least};
    if (shares.x() < least) shares = {least, A(1, 1) > 0 ? std::max(least, right.y() / A(1, 1)) : least};
  }
  return shares;
}

/// Sums of one kind of residual, a second.
struct Component {
  double squares = 0;
  double redundancy = 0;
  void add(double residual, double redundant, double seconds) {
    squares += residual * residual / seconds;
    redundancy += std::max(0.0, redundant);
  }
  /// What the variance comes to; with less than ten residuals' worth of evidence it stays.
  [[nodiscard]] double variance(double before) const { return redundancy < 10 ? before : squares / redundancy; }
};

/// What a robot's odometry is off by.
struct OdometryResiduals {
  Component forward, sideways;
  std::vector<SquaredResidual> turning;

  void add(const PosePose& m, const Pose2& T_a_b, const Matrix3d& covariance, double seconds, double told,
           double gain) {
    const Pose2 e = m.T_a_b.inverse() * T_a_b;
    const Matrix3d P = turned(covariance, -m.T_a_b.yaw);
    forward.add(e.x / gain, 1 - m.information(0, 0) * P(0, 0), seconds);
    sideways.add(e.y / gain, 1 - m.information(1, 1) * P(1, 1), seconds);
    turning.push_back({{seconds, std::abs(told)}, e.yaw * e.yaw + P(2, 2)});
  }

  [[nodiscard]] OdometryModel model(OdometryModel m) const {
    constexpr double kLeast = 1e-8;
    m.forward_rate = forward.variance(m.forward_rate);
    m.sideways_rate = sideways.variance(m.sideways_rate);
    const Vector2d shares = fit_shares(turning, {m.turning_rate, m.turning_share}, kLeast);
    m.turning_rate = shares.x();
    m.turning_share = shares.y();
    return m;
  }
};

/// A detection's residual: in range (metres) and bearing (radians), and how well the fit knows either.
struct DetectionResidual {
  double range = 0;  ///< as fitted
  double of_range = 0;
  double of_bearing = 0;
  double range_variance = 0;    ///< of the fitted range
  double bearing_variance = 0;  ///< of the fitted bearing
};

DetectionResidual residual_of(const Detection& d, const PointPosition& m, const Pose2& T_a_b,
                              const Matrix3d& covariance) {
  const Vector2d along = m.p_a.normalized();
  const Vector2d across = Vector2d(-along.y(), along.x()) / d.range;
  const Vector2d e = T_a_b.translation() - m.p_a;
  const Matrix2d P = covariance.topLeftCorner<2, 2>();
  return {T_a_b.distance(), e.dot(along), e.dot(across), along.dot(P * along), across.dot(P * across)};
}

void centre(std::vector<double>& values) {
  const double mean =
      std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(std::max<std::size_t>(1, values.size()));
  for (double& v : values) v -= mean;
}

/// The integrated autocorrelation 1 + 2 sum rho_k of sequences, as far as it is plainly positive.
double kappa_of(const std::vector<std::vector<double>>& sequences) {
  constexpr std::size_t kLongest = 100;
  constexpr double kPlain = 0.1;
  double kappa = 1;
  double first = 0;
  for (std::size_t lag = 0; lag <= kLongest; ++lag) {
    double sum = 0;
    double count = 0;
    for (const auto& u : sequences) {
      for (std::size_t i = lag; i < u.size(); ++i) sum += u[i] * u[i - lag], ++count;
    }
    if (count < 30) break;
    if (lag == 0) {
      first = sum / count;
      continue;
    }
    const double rho = sum / count / first;
    if (!(rho > kPlain)) break;
    kappa += 2 * rho;
  }
  return kappa;
}

/// A robot's detections, subject by subject, in order of time.
class DetectionResiduals {
 public:
  void add(std::uint32_t subject, const DetectionResidual& r) {
    all_.push_back(r);
    if (of_subject_.size() <= subject) of_subject_.resize(subject + 1);
    of_subject_[subject].push_back(r);
  }

  [[nodiscard]] DetectionModel model(DetectionModel m) const {
    if (all_.size() < 20) return m;
    constexpr double kLeast = 1e-6;  // no ranging is better than a millimetre
    std::vector<SquaredResidual> of_range;
    double squares = 0;
    for (const DetectionResidual& r : all_) {
      of_range.push_back({{1, r.range * r.range}, r.of_range * r.of_range + r.range_variance});
      squares += r.of_bearing * r.of_bearing + r.bearing_variance;
    }
    const Vector2d shares = fit_shares(of_range, {std::pow(m.range_floor, 2), std::pow(m.range_share, 2)}, kLeast);
    m.range_floor = std::sqrt(shares.x());
    m.range_share = std::sqrt(shares.y());
    m.bearing_sigma = std::sqrt(squares / static_cast<double>(all_.size()));
    std::vector<std::vector<double>> ranges;
    std::vector<std::vector<double>> bearings;
    for (const auto& residuals : of_subject_) {
      auto& range = ranges.emplace_back();
      auto& bearing = bearings.emplace_back();
      for (const DetectionResidual& r : residuals) {
        range.push_back(r.of_range / std::sqrt(m.range_variance(r.range)));
        bearing.push_back(r.of_bearing);
      }
      centre(range);
      centre(bearing);
    }
    m.range_kappa = kappa_of(ranges);
    m.bearing_kappa = kappa_of(bearings);
    return m;
  }

 private:
  std::vector<DetectionResidual> all_;
  std::vector<std::vector<DetectionResidual>> of_subject_;
};

}  // namespace

std::vector<bool> find_wrong(const TeamLog& log, const TeamGraph& team, const TeamModel& model, double gate) {
  const std::vector<Pose2>& poses = team.graph.poses;
  std::vector<bool> wrong(team.graph.relations.size(), false);
  for (std::size_t i = team.odometry; i < wrong.size(); ++i) {
    const GraphRelation& r = team.graph.relations[i];
    const DetectionPlace& place = team.place_of(i);
    const Detection& d = log.robots[place.robot].detections[place.index];
    const DetectionModel& m = model.detection[place.robot];
    const DetectionResidual e =
        residual_of(d, std::get<PointPosition>(r.measurement), poses[r.a].inverse() * poses[r.b], Matrix3d::Zero());
    const double chi2 =
        e.of_range * e.of_range / m.range_variance(e.range) + std::pow(e.of_bearing / m.bearing_sigma, 2);
    wrong[i] = chi2 > gate * gate;
  }
  return wrong;
}

TeamModel fit_variances(const TeamLog& log, const TeamNodes& nodes, const TeamGraph& team, const TeamModel& before) {
  const std::vector<Pose2>& poses = team.graph.poses;
  LinearSystem system(team.graph, default_gauge(team.graph));
  system.linearise(poses);
  if (!system.factorise()) return before;
  std::vector<OdometryResiduals> odometry(log.robots.size());
  std::vector<DetectionResiduals> detections(log.robots.size());
  for (std::size_t i = 0; i < team.graph.relations.size(); ++i) {
    const GraphRelation& r = team.graph.relations[i];
    const Pose2 T_a_b = poses[r.a].inverse() * poses[r.b];
    const Matrix3d covariance = system.relative_covariance(T_a_b, r.a, r.b);
    const std::size_t robot = nodes.robot_of(r.a);
    if (const auto* step = std::get_if<PosePose>(&r.measurement)) {
      const double* stamps = nodes.stamps_of(robot).data() + (r.a - nodes.first_of(robot));
      const OdometryModel& model = before.odometry[robot];
      const CommandedMotion motion(log.robots[robot].velocities, model);
      odometry[robot].add(*step, T_a_b, covariance, stamps[1] - stamps[0], motion.told(stamps[0], stamps[1]).turning,
                          model.forward_gain);
    } else {
      const Detection& d = log.robots[robot].detections[team.place_of(i).index];
      detections[robot].add(d.subject, residual_of(d, std::get<PointPosition>(r.measurement), T_a_b, covariance));
    }
  }
  TeamModel model = before;
  for (std::size_t i = 0; i < log.robots.size(); ++i) {
    model.odometry[i] = odometry[i].model(model.odometry[i]);
    model.detection[i] = detections[i].model(model.detection[i]);
  }
  return model;
}

}  // namespace helicoid
