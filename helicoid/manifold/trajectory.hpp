// Where a robot's scans were taken, in sixteen bytes a scan: on known ground they are all that a map grows by.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <iterator>
#include <vector>

#include "helicoid/base/ids.hpp"
#include "helicoid/geometry/pose2.hpp"

namespace helicoid {

/// A pose on the manifold: the paper's rho = (pi, r).
struct ManifoldPose {
  PatchId patch;
  Pose2 T_patch_robot;
  friend bool operator==(const ManifoldPose&, const ManifoldPose&) = default;
};

/// Where one scan was taken. The same place whatever a later fit does to the patch's pose.
struct TrackedScan {
  double stamp = 0;                        ///< seconds
  ManifoldPose pose;                       ///< as matched
  Pose2 T_island_patch_online;             ///< where the patch was projected when the scan was taken
  Matrix3d covariance = Matrix3d::Zero();  ///< of T_patch_robot, in the patch's frame, noise floor not included

  /// The projected pose as it was first reported.
  [[nodiscard]] Pose2 T_island_robot_online() const { return T_island_patch_online * pose.T_patch_robot; }
};

/// One entry a scan, in the log's order. What is read differs from what was appended by rounding: stamps by a
/// microsecond, positions by 1.6e-5 of their size, headings by 5e-5 rad; standard deviations are rounded up by at most
/// a sixteenth, correlations towards zero by at most a fifteenth. Appending what was read gives the same trajectory, to
/// the bit.
class Trajectory {
 public:
  class Iterator {
   public:
    using iterator_category = std::input_iterator_tag;
    using value_type = TrackedScan;
    using difference_type = std::ptrdiff_t;
    using pointer = void;
    using reference = TrackedScan;
    Iterator(const Trajectory& trajectory, std::size_t at) : trajectory_(&trajectory), at_(at) {}
    TrackedScan operator*() const;
    Iterator& operator++();
    bool operator==(const Iterator& other) const { return at_ == other.at_; }

   private:
    const Trajectory* trajectory_;
    std::size_t at_;
    std::size_t stretch_ = 0;
  };

  /// The scan stands on a patch of the map.
  void push_back(const TrackedScan& scan);
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] TrackedScan operator[](std::size_t i) const;
  /// The scan's stamp alone.
  [[nodiscard]] double stamp(std::size_t i) const;
  /// The last scan, in the log's order, whose stamp is not after this one; size() if there is none.
  [[nodiscard]] std::size_t last_not_after(double stamp) const;
  [[nodiscard]] TrackedScan front() const { return (*this)[0]; }
  [[nodiscard]] TrackedScan back() const { return (*this)[size() - 1]; }
  [[nodiscard]] Iterator begin() const { return {*this, 0}; }
  [[nodiscard]] Iterator end() const { return {*this, size()}; }
  /// Memory, bookkeeping left out.
  [[nodiscard]] std::size_t bytes() const;

 private:
  /// Where a patch was projected for a time.
  struct Ground {
    PatchId patch;
    Pose2 T_island_patch;
  };
  /// Scans in a row on one ground.
  struct Stretch {
    std::uint32_t first = 0;
    std::uint32_t ground = 0;
  };
  /// From which a scan and those after it count their microseconds.
  struct Clock {
    std::uint32_t first = 0;
    double stamp = 0;
  };
  using ThreeBytes = std::array<std::uint8_t, 3>;
  struct Place {
    ThreeBytes x, y;             ///< of T_patch_robot: the upper three bytes of a float
    ThreeBytes microseconds;     ///< since the clock
    ThreeBytes deviations;       ///< of x, y and yaw: steps of a logarithmic scale
    std::uint16_t yaw;           ///< of T_patch_robot, in 65536ths of a turn
    std::uint16_t correlations;  ///< of (x, y), (x, yaw), (y, yaw): fifteenths, five bits each
  };

  static constexpr std::size_t kBlock = 1024;

  [[nodiscard]] TrackedScan read(std::size_t stretch, std::size_t i) const;
  std::uint32_t ground_of(const TrackedScan& scan);
  static void put_covariance(Place& place, const Matrix3d& covariance);
  static Matrix3d covariance_of(const Place& place);

  std::size_t size_ = 0;
  std::vector<std::vector<Place>> blocks_;  ///< of kBlock scans: one list would hold room for twice as many
  std::deque<Stretch> stretches_;
  std::vector<Ground> grounds_;
  std::vector<std::uint32_t> latest_ground_;  ///< by patch: its newest in grounds_, one more; 0: none
  std::vector<Clock> clocks_;
};

}  // namespace helicoid
