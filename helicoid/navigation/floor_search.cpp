#include "helicoid/navigation/floor_search.hpp"

#include <algorithm>
#include <cmath>

namespace helicoid {

namespace {

/// A straight step in comfort; a diagonal one is 14.
constexpr std::uint32_t kStraight = 10;
constexpr std::uint32_t kDiagonal = 14;

/// The cost of a straight and a diagonal step into a place, by its clearance in centimetres; 0: not passable.
struct StepCosts {
  std::array<std::array<std::uint32_t, 2>, 256> of{};
  std::uint32_t most = 0;

  explicit StepCosts(const FloorPlan& plan) {
    const int least = least_clearance_cm(plan.options);
    const double comfortable = 100 * std::min(plan.options.comfortable, kMostClearance);
    for (int cm = least; cm < 256; ++cm) {
      const double tightness = std::clamp((comfortable - cm) / std::max(comfortable - least, 1.0), 0.0, 1.0);
      const double factor = 1 + plan.options.discomfort * tightness;
      auto& costs = of[static_cast<std::size_t>(cm)];
      costs = {static_cast<std::uint32_t>(std::lround(kStraight * factor)),
               static_cast<std::uint32_t>(std::lround(kDiagonal * factor))};
      most = std::max(most, costs[1]);
    }
  }
};

/// A queue of places by cost, where no step costs more than `most`: as many buckets in a ring.
class BucketQueue {
 public:
  explicit BucketQueue(std::uint32_t most) : buckets_(most + 1) {}
  void push(std::uint32_t cost, std::uint32_t place) {
    buckets_[cost % buckets_.size()].push_back(place);
    ++size_;
  }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  /// The cost of the cheapest.
  std::uint32_t cost() {
    while (buckets_[at_ % buckets_.size()].empty()) ++at_;
    return at_;
  }
  std::uint32_t pop() {
    std::vector<std::uint32_t>& bucket = buckets_[cost() % buckets_.size()];
    const std::uint32_t place = bucket.back();
    bucket.pop_back();
    --size_;
    return place;
  }

 private:
  std::vector<std::vector<std::uint32_t>> buckets_;
  std::uint32_t at_ = 0;
  std::size_t size_ = 0;
};

template <class F>
void for_each_direction(F&& f) {
  for (int dr = -1; dr <= 1; ++dr) {
    for (int dc = -1; dc <= 1; ++dc) {
      if (dc != 0 || dr != 0) f(dc, dr);
    }
  }
}

}  // namespace

std::optional<FloorPlace> standing_near(const FloorPlan& plan, const FloorPlace& place, double reach) {
  const int least = least_clearance_cm(plan.options);
  const Vector2d from = plan.centre(place);
  std::vector<FloorPlace> seen{place};
  std::optional<FloorPlace> best;
  double nearest = reach;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const FloorPlace at = seen[i];
    const double distance = (plan.centre(at) - from).norm();
    if (distance > nearest) continue;
    if (plan.clearance_cm(at) >= least) {
      best = at;
      nearest = distance;
      continue;
    }
    for_each_direction([&](int dc, int dr) {
      plan.for_each_next(at, dc, dr, [&](const FloorPlace& next) {
        const int clearance = plan.clearance_cm(next);
        if (clearance == 0 || clearance < plan.clearance_cm(at)) return;
        if (std::find(seen.begin(), seen.end(), next) == seen.end()) seen.push_back(next);
      });
    });
  }
  return best;
}

std::vector<FloorPlace> FloorSearch::way_to(const FloorPlace& place) const {
  std::uint32_t at = number_of(place);
  std::vector<FloorPlace> way;
  if (cost[at] == kNone) return way;
  for (; parent[at] != at; at = parent[at]) way.push_back(place_of(at));
  way.push_back(place_of(at));
  std::reverse(way.begin(), way.end());
  return way;
}

FloorSearch search_floor(const FloorPlan& plan, const FloorPlace& start, const std::optional<FloorPlace>& goal,
                         const std::vector<bool>& closed) {
  FloorSearch search{std::vector<std::uint32_t>(plan.place_count(), FloorSearch::kNone),
                     std::vector<std::uint32_t>(plan.place_count(), FloorSearch::kNone),
                     std::vector<float>(plan.place_count(), std::numeric_limits<float>::infinity())};
  const StepCosts costs(plan);
  BucketQueue queue(costs.most);
  const std::uint32_t first = number_of(start);
  search.cost[first] = 0;
  search.parent[first] = first;
  search.length[first] = 0;
  queue.push(0, first);
  while (!queue.empty()) {
    const std::uint32_t cost = queue.cost();
    const std::uint32_t number = queue.pop();
    if (cost != search.cost[number]) continue;
    if (goal && number == number_of(*goal)) break;
    const FloorPlace at = place_of(number);
    for_each_direction([&](int dc, int dr) {
      const bool diagonal = dc != 0 && dr != 0;
      plan.for_each_next(at, dc, dr, [&](const FloorPlace& next) {
        const std::uint32_t step = costs.of[static_cast<std::size_t>(plan.clearance_cm(next))][diagonal ? 1 : 0];
        const std::uint32_t to = number_of(next);
        if (step == 0 || cost + step >= search.cost[to] || (!closed.empty() && closed[to])) return;
        search.cost[to] = cost + step;
        search.parent[to] = number;
        search.length[to] =
            search.length[number] + static_cast<float>(kFloorCell * (diagonal ? std::numbers::sqrt2 : 1.0));
        queue.push(cost + step, to);
      });
    });
  }
  return search;
}

}  // namespace helicoid
