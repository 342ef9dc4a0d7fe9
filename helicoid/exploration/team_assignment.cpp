#include "helicoid/exploration/team_assignment.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "helicoid/exploration/optimal_assignment.hpp"

namespace helicoid {

namespace {

using Choice = std::vector<std::optional<std::size_t>>;

constexpr int kMostRounds = 20;

/// The terms of team_value, tabled.
class TeamValue {
 public:
  TeamValue(std::span<const Frontier> frontiers, const Eigen::MatrixXd& way,
            std::span<const std::optional<std::size_t>> going_to, const AssignmentOptions& options)
      : alone_(way.rows(), way.cols()), shared_(way.cols(), way.cols()) {
    const auto worth = [&](double m2) { return options.metres_per_m2 * std::min(m2, options.most_gain); };
    for (Eigen::Index f = 0; f < way.cols(); ++f) {
      const Frontier& frontier = frontiers[static_cast<std::size_t>(f)];
      for (Eigen::Index r = 0; r < way.rows(); ++r) {
        const bool goes_on = going_to[static_cast<std::size_t>(r)] == static_cast<std::size_t>(f);
        alone_(r, f) = worth(frontier.gain_m2) - way(r, f) + (goes_on ? options.hysteresis : 0);
      }
      for (Eigen::Index g = 0; g < way.cols(); ++g) {
        const Frontier& other = frontiers[static_cast<std::size_t>(g)];
        const double both = worth(frontier.gain_m2) + worth(other.gain_m2);
        const double seen = frontier.gain_m2 + other.gain_m2;
        shared_(f, g) = seen > 0 ? both * shared_gain(frontier, other) / seen : 0;
      }
    }
  }
  [[nodiscard]] const Eigen::MatrixXd& alone() const { return alone_; }
  [[nodiscard]] double of(const Choice& chosen) const {
    double value = 0;
    for (std::size_t r = 0; r < chosen.size(); ++r) {
      if (!chosen[r]) continue;
      const auto f = static_cast<Eigen::Index>(*chosen[r]);
      value += alone_(static_cast<Eigen::Index>(r), f);
      for (std::size_t s = 0; s < r; ++s) {
        if (chosen[s]) value -= shared_(f, static_cast<Eigen::Index>(*chosen[s]));
      }
    }
    return value;
  }

 private:
  Eigen::MatrixXd alone_;   ///< by robot and frontier; -infinity where there is no way
  Eigen::MatrixXd shared_;  ///< by frontiers: what is counted twice
};

bool is_taken(const Choice& chosen, std::size_t frontier) {
  return std::find(chosen.begin(), chosen.end(), frontier) != chosen.end();
}

/// One robot goes elsewhere, or two change places: the first of these that is better for the team.
bool improve(const TeamValue& value, Choice& chosen) {
  const double now = value.of(chosen) + 1e-9;
  for (std::size_t r = 0; r < chosen.size(); ++r) {
    Choice other = chosen;
    if (!chosen[r]) continue;
    for (std::size_t f = 0; f < static_cast<std::size_t>(value.alone().cols()); ++f) {
      if (is_taken(chosen, f)) continue;
      other[r] = f;
      if (value.of(other) > now) {
        chosen = other;
        return true;
      }
    }
    for (std::size_t s = 0; s < r; ++s) {
      other = chosen;
      std::swap(other[r], other[s]);
      if (value.of(other) > now) {
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
  const TeamValue value(frontiers, way, going_to, options);
  // The best if no two frontiers showed the same; then what they share is taken into account.
  Choice chosen = optimal_assignment(-value.alone());
  for (int round = 0; round < kMostRounds * static_cast<int>(chosen.size()) && improve(value, chosen); ++round) {
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

double team_value(std::span<const Frontier> frontiers, const Eigen::MatrixXd& way,
                  std::span<const std::optional<std::size_t>> going_to,
                  std::span<const std::optional<std::size_t>> chosen, const AssignmentOptions& options) {
  return TeamValue(frontiers, way, going_to, options).of(Choice(chosen.begin(), chosen.end()));
}

}  // namespace helicoid
