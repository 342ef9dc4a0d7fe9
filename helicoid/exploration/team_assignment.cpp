#include "helicoid/exploration/team_assignment.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "helicoid/exploration/optimal_assignment.hpp"

namespace helicoid {

namespace {

using Choice = std::vector<std::optional<std::size_t>>;

constexpr int kMostRounds = 20;

/// The terms of team_rate, tabled.
class TeamRate {
 public:
  TeamRate(std::span<const Frontier> frontiers, const Eigen::MatrixXd& way,
           std::span<const std::optional<std::size_t>> going_to, const AssignmentOptions& options)
      : alone_(way.rows(), way.cols()), lost_(way.cols(), way.cols()) {
    for (Eigen::Index f = 0; f < way.cols(); ++f) {
      const Frontier& frontier = frontiers[static_cast<std::size_t>(f)];
      for (Eigen::Index r = 0; r < way.rows(); ++r) {
        const bool goes_on = going_to[static_cast<std::size_t>(r)] == static_cast<std::size_t>(f);
        const double metres = std::max(0.0, way(r, f) - (goes_on ? options.hysteresis : 0)) + options.look_m;
        alone_(r, f) = std::isfinite(metres) ? (frontier.gain_m2 + options.return_saved_m2) / metres : kNoWay;
      }
      for (Eigen::Index g = 0; g < way.cols(); ++g) {
        const double shared = shared_gain(frontier, frontiers[static_cast<std::size_t>(g)]);
        lost_(f, g) = shared > 0 ? 0.5 * shared / frontier.gain_m2 : 0;
      }
    }
  }
  [[nodiscard]] const Eigen::MatrixXd& alone() const { return alone_; }
  [[nodiscard]] double of(const Choice& chosen) const {
    double rate = 0;
    for (std::size_t r = 0; r < chosen.size(); ++r) {
      if (!chosen[r]) continue;
      const auto f = static_cast<Eigen::Index>(*chosen[r]);
      double left = 1;
      for (std::size_t s = 0; s < chosen.size(); ++s) {
        if (s != r && chosen[s]) left -= lost_(f, static_cast<Eigen::Index>(*chosen[s]));
      }
      rate += alone_(static_cast<Eigen::Index>(r), f) * std::max(0.0, left);
    }
    return rate;
  }

 private:
  static constexpr double kNoWay = -std::numeric_limits<double>::infinity();
  Eigen::MatrixXd alone_;  ///< by robot and frontier, m2 a metre; -infinity where there is no way
  Eigen::MatrixXd lost_;   ///< by frontiers f, g: the share of f that does not count for f if g is looked at, too
};

bool is_taken(const Choice& chosen, std::size_t frontier) {
  return std::find(chosen.begin(), chosen.end(), frontier) != chosen.end();
}

/// One robot goes elsewhere, or two change places: the first of these that is better for the team.
bool improve(const TeamRate& rate, Choice& chosen) {
  const double now = rate.of(chosen) + 1e-9;
  for (std::size_t r = 0; r < chosen.size(); ++r) {
    Choice other = chosen;
    if (!chosen[r]) continue;
    for (std::size_t f = 0; f < static_cast<std::size_t>(rate.alone().cols()); ++f) {
      if (is_taken(chosen, f)) continue;
      other[r] = f;
      if (rate.of(other) > now) {
        chosen = other;
        return true;
      }
    }
    for (std::size_t s = 0; s < r; ++s) {
      other = chosen;
      std::swap(other[r], other[s]);
      if (rate.of(other) > now) {
        chosen = other;
        return true;
      }
    }
  }
  return false;
}

}  // namespace

std::vector<std::optional<std::size_t>> assign_frontiers(std::span<const Frontier> frontiers,
                                                         const Eigen::MatrixXd& way,
                                                         std::span<const std::optional<std::size_t>> going_to,
                                                         const AssignmentOptions& options) {
  const TeamRate rate(frontiers, way, going_to, options);
  // The best if no two frontiers showed the same; then what they share is taken into account.
  Choice chosen = optimal_assignment(-rate.alone());
  for (int round = 0; round < kMostRounds * static_cast<int>(chosen.size()) && improve(rate, chosen); ++round) {
  }
  return chosen;
}

Eigen::MatrixXd ways_of_free(const Eigen::MatrixXd& way, std::span<const std::uint8_t> is_free) {
  Eigen::MatrixXd free = way;
  for (Eigen::Index r = 0; r < free.rows(); ++r) {
    if (is_free[static_cast<std::size_t>(r)] == 0) free.row(r).setConstant(std::numeric_limits<double>::infinity());
  }
  return free;
}

std::vector<std::optional<std::size_t>> nearest_frontiers(const Eigen::MatrixXd& way) {
  Choice chosen(static_cast<std::size_t>(way.rows()));
  for (Eigen::Index r = 0; r < way.rows() && way.cols() > 0; ++r) {
    Eigen::Index nearest = 0;
    if (std::isfinite(way.row(r).minCoeff(&nearest))) chosen[static_cast<std::size_t>(r)] = nearest;
  }
  return chosen;
}

double team_rate(std::span<const Frontier> frontiers, const Eigen::MatrixXd& way,
                 std::span<const std::optional<std::size_t>> going_to,
                 std::span<const std::optional<std::size_t>> chosen, const AssignmentOptions& options) {
  return TeamRate(frontiers, way, going_to, options).of(Choice(chosen.begin(), chosen.end()));
}

}  // namespace helicoid
