#include "helicoid/simulation/true_relations.hpp"

#include <algorithm>
#include <cmath>

#include "helicoid/base/random.hpp"

namespace helicoid {

namespace {

double distance(const Pose2& a, const Pose2& b) {
  return std::hypot(a.x - b.x, a.y - b.y);
}

void add_local(const TrueTrack& track, std::size_t robot, const TrueRelationsOptions& options, Random& random,
               std::vector<ScanPair>& pairs) {
  double next = -INFINITY;
  for (std::size_t i = 0; i < track.stamps.size(); ++i) {
    if (track.stamps[i] < next) continue;
    next = track.stamps[i] + options.every;
    const double until = track.stamps[i] + options.longest_gap * random.uniform();
    std::size_t j = i + 1;
    while (j + 1 < track.stamps.size() && track.stamps[j + 1] <= until) ++j;
    if (j < track.stamps.size() && track.stamps[j] - track.stamps[i] <= options.longest_gap) {
      pairs.push_back({robot, i, robot, j});
    }
  }
}

void add_revisits(const TrueTrack& track, std::size_t robot, const TrueRelationsOptions& options, Random& random,
                  std::vector<ScanPair>& pairs) {
  if (track.stamps.empty()) return;
  std::size_t found = 0;
  for (std::size_t k = 0; k < options.tries && found < options.most; ++k) {
    std::size_t i = random.below(track.stamps.size());
    std::size_t j = random.below(track.stamps.size());
    if (i > j) std::swap(i, j);
    if (track.stamps[j] - track.stamps[i] < options.revisit_gap ||
        distance(track.T_world_robot[i], track.T_world_robot[j]) > options.revisit_near) {
      continue;
    }
    pairs.push_back({robot, i, robot, j});
    ++found;
  }
}

void add_meetings(std::span<const TrueTrack> tracks, std::size_t a, std::size_t b, const TrueRelationsOptions& options,
                  Random& random, std::vector<ScanPair>& pairs) {
  if (tracks[a].stamps.empty() || tracks[b].stamps.empty()) return;
  std::size_t found = 0;
  for (std::size_t k = 0; k < options.tries && found < options.most; ++k) {
    const std::size_t i = random.below(tracks[a].stamps.size());
    const std::size_t j = random.below(tracks[b].stamps.size());
    if (distance(tracks[a].T_world_robot[i], tracks[b].T_world_robot[j]) > options.meeting_near) continue;
    pairs.push_back({a, i, b, j});
    ++found;
  }
}

}  // namespace

std::vector<ScanPair> choose_true_relations(std::span<const TrueTrack> tracks, std::uint64_t seed,
                                            const TrueRelationsOptions& options) {
  Random random(seed);
  std::vector<ScanPair> pairs;
  for (std::size_t a = 0; a < tracks.size(); ++a) {
    add_local(tracks[a], a, options, random, pairs);
    add_revisits(tracks[a], a, options, random, pairs);
    for (std::size_t b = a + 1; b < tracks.size(); ++b) add_meetings(tracks, a, b, options, random, pairs);
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

}  // namespace helicoid
