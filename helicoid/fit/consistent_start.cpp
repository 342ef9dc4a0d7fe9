#include "helicoid/fit/consistent_start.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "helicoid/fit/cpu_clock.hpp"
#include "helicoid/fit/initial_guess.hpp"
#include "helicoid/fit/innovation.hpp"

namespace helicoid {

namespace {

/// Noise has heavier tails than a Gaussian of its variance: gates are those of twice the standard deviation found, but
/// never wider than stated noise makes them.
double noise_scale(double variance_factor) {
  constexpr double kCaution = 4;
  return std::clamp(kCaution * variance_factor, 1e-3, 1.0);
}

/// Moves each component so that the poses that are held stand where they were.
std::vector<Pose2> hold(std::vector<Pose2> poses, const RelationGraph& graph, std::span<const std::uint32_t> fixed) {
  const std::vector<bool> is_fixed = [&] {
    std::vector<bool> is(graph.poses.size(), false);
    for (const std::uint32_t node : fixed) is[node] = true;
    return is;
  }();
  for (const Component& component : find_components(graph)) {
    const auto held = std::find_if(component.nodes.begin(), component.nodes.end(),
                                   [&is_fixed](std::uint32_t node) { return is_fixed[node]; });
    if (held == component.nodes.end()) continue;
    const Pose2 move = graph.poses[*held] * poses[*held].inverse();
    for (const std::uint32_t node : component.nodes) poses[node] = move * poses[node];
  }
  for (const std::uint32_t node : fixed) poses[node] = graph.poses[node];
  return poses;
}

/// A relation that may be wrong, as it stands to the fit.
struct Asked {
  std::uint32_t relation;
  Innovation innovation;
};

class Consistency {
 public:
  Consistency(const RelationGraph& graph, std::span<const std::uint32_t> fixed, const FitOptions& options)
      : graph_(graph), fixed_(fixed), options_(options) {
    start_.poses = graph.poses;
    for (std::uint32_t i = 0; i < graph.relations.size(); ++i) {
      start_.accepted.push_back(!graph.relations[i].may_be_wrong);
      if (graph.relations[i].may_be_wrong) open_.push_back(i);
    }
    times_dropped_.assign(graph.relations.size(), 0);
    constexpr double kErrors = 1e-3;
    own_gate_ = options.loss.width * options.loss.width;
    common_gate_ = own_gate_;
    if (!open_.empty())
      common_gate_ = std::max(own_gate_, chi_square_quantile(kErrors / static_cast<double>(open_.size())));
  }

  ConsistentStart run() {
    const std::vector<std::uint32_t> all = open_;
    grow(own_gate_);
    std::swap(open_, refused_);
    grow(common_gate_);
    open_ = all;
    settle();
    return std::move(start_);
  }

 private:
  [[nodiscard]] FittedPart fitted() const { return {graph_, start_.accepted, start_.poses, fixed_, options_}; }

  /// While few relations held them, poses may have come to rest in a local optimum: a global start tells.
  void leave_local_optimum() {
    const FittedPart here = fitted();
    const FittedPart there(graph_, start_.accepted, hold(chordal_start(here.graph()), here.graph(), fixed_), fixed_,
                           options_);
    start_.poses = there.cost() < here.cost() ? there.poses() : here.poses();
  }

  /// The relations of this side, with their innovations.
  [[nodiscard]] std::vector<Asked> ask(const FittedPart& part, bool accepted) const {
    std::vector<Asked> asked;
    for (const std::uint32_t i : open_) {
      if (start_.accepted[i] == accepted) asked.push_back({i, part.innovation(graph_.relations[i], accepted)});
    }
    return asked;
  }

  static void sort_by_volume(std::vector<Asked>& asked) {
    std::stable_sort(asked.begin(), asked.end(),
                     [](const Asked& l, const Asked& r) { return l.innovation.log_volume < r.innovation.log_volume; });
  }

  /// How much less those that agreed differ from their predictions than stated: where odometry is stated with caution,
  /// a gate as wide as stated would let wrong relations in.
  [[nodiscard]] double innovation_scale() const {
    constexpr double kMedian = 2.366;  // of chi^2 with 3 degrees of freedom
    constexpr std::size_t kEnough = 10;
    if (agreed_.size() < kEnough) return 1;
    std::vector<double> sorted = agreed_;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    return noise_scale(*middle / kMedian);
  }

  /// Takes in what agrees of the open relations, from the best predicted to the worst.
  void grow(double gate) {
    while (!open_.empty()) {
      const FittedPart part = fitted();
      start_.is_determined = start_.is_determined && part.is_determined();
      if (!start_.is_determined) return;
      start_.poses = part.poses();
      std::vector<Asked> asked = ask(part, false);
      sort_by_volume(asked);
      // Some a round: what is taken in sharpens the prediction of the rest.
      asked.resize(std::min(open_.size(), std::max<std::size_t>(30, asked_ / 4)));
      asked_ += asked.size();
      const double scaled = gate * innovation_scale();
      std::vector<bool> is_asked(graph_.relations.size(), false);
      for (const Asked& a : asked) {
        const bool agrees = a.innovation.chi2 <= scaled;
        start_.accepted[a.relation] = agrees;
        if (agrees) agreed_.push_back(a.innovation.chi2);
        if (!agrees) refused_.push_back(a.relation);
        is_asked[a.relation] = true;
      }
      std::erase_if(open_, [&is_asked](std::uint32_t i) { return is_asked[i]; });
    }
  }

  /// Lets go what the others contradict, the worst first: it may be why others look wrong. True if there was any.
  bool drop(const FittedPart& part) {
    std::vector<Asked> asked = ask(part, true);
    double most = 0;
    for (const Asked& a : asked) most = std::max(most, a.innovation.chi2);
    if (most <= start_.gate) return false;
    for (const Asked& a : asked) {
      if (a.innovation.chi2 <= std::max(start_.gate, most / 2)) continue;
      start_.accepted[a.relation] = false;
      ++times_dropped_[a.relation];
    }
    return true;
  }

  /// Takes in what agrees with the others, the better predicted half. True if there was any.
  bool take_in(const FittedPart& part) {
    constexpr int kMostDrops = 2;  // what comes and goes is left out
    std::vector<Asked> asked = ask(part, false);
    std::erase_if(asked, [this](const Asked& a) {
      return a.innovation.chi2 > start_.gate || times_dropped_[a.relation] == kMostDrops;
    });
    sort_by_volume(asked);
    asked.resize((asked.size() + 1) / 2);
    for (const Asked& a : asked) start_.accepted[a.relation] = true;
    return !asked.empty();
  }

  void settle() {
    constexpr int kMostRounds = 200;
    bool changes = start_.is_determined;
    if (changes) leave_local_optimum();
    for (int round = 0; changes && round < kMostRounds; ++round) {
      const FittedPart part = fitted();
      start_.is_determined = part.is_determined();
      if (!start_.is_determined) return;
      start_.poses = part.poses();
      start_.gate = common_gate_ * noise_scale(part.variance_factor());
      changes = drop(part) || take_in(part);
    }
  }

  const RelationGraph& graph_;
  std::span<const std::uint32_t> fixed_;
  const FitOptions& options_;
  ConsistentStart start_;
  double own_gate_ = 0;
  double common_gate_ = 0;
  std::vector<std::uint32_t> open_;
  std::vector<std::uint32_t> refused_;
  std::vector<int> times_dropped_;  ///< of each relation
  std::vector<double> agreed_;      ///< chi^2 of innovations
  std::size_t asked_ = 0;
};

}  // namespace

double chi_square_quantile(double exceedance) {
  // With 3 degrees of freedom P(chi^2 > q) = erfc(sqrt(q/2)) + sqrt(2q/pi) exp(-q/2), which falls.
  const auto exceeds = [](double q) {
    return std::erfc(std::sqrt(q / 2)) + std::sqrt(2 * q / std::numbers::pi) * std::exp(-q / 2);
  };
  double low = 0;
  double high = 1;
  while (exceeds(high) > exceedance) high *= 2;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (exceeds(middle) > exceedance ? low : high) = middle;
  }
  return high;
}

ConsistentStart consistent_start(const RelationGraph& graph, std::span<const std::uint32_t> fixed,
                                 const FitOptions& options) {
  double seconds = 0;
  ConsistentStart start;
  {
    const CpuTimer timer(seconds);
    start = Consistency(graph, fixed, options).run();
  }
  start.cpu_s = seconds;
  return start;
}

}  // namespace helicoid
