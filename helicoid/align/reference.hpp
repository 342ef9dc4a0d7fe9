// What a scan is aligned to: the surfaces of a few patches, fused into one table of small surface elements.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "helicoid/geometry/pose2.hpp"
#include "helicoid/sensor/scan_points.hpp"

namespace helicoid {

/// One patch's points and where the patch stands relative to the reference's frame.
struct ReferencePart {
  const ScanPoints* points = nullptr;
  Pose2 T_reference_patch;
};

/// A piece of surface: the weighted mean of the points that fell on it, with the normal of the side it was seen from.
struct SurfaceElement {
  float x, y;    ///< metres, reference frame
  float nx, ny;  ///< unit normal, towards the observers
  float weight;  ///< sum of the points' weights
  float facing;  ///< weighted mean of the points' (ScanPoints::facing)
};

/// Surface elements in a grid, row by row, so that a search reads a few contiguous runs. Rebuilt when the robot has
/// moved on; its buffers are kept, so that no rebuild allocates once they have grown.
class Reference {
 public:
  void build(std::span<const ReferencePart> parts);
  [[nodiscard]] std::size_t size() const { return elements_.size(); }
  [[nodiscard]] bool empty() const { return elements_.empty(); }
  [[nodiscard]] std::span<const SurfaceElement> elements() const { return elements_; }

  /// The nearest element within `gate` metres whose normal agrees (cosine above kSameSide), or nullptr.
  [[nodiscard]] const SurfaceElement* nearest(float x, float y, float nx, float ny, float gate) const;

  static constexpr float kCell = 0.25F;
  /// Normals that differ more than this belong to another side, or to another wall of a corner.
  static constexpr float kSameSide = 0.7F;

 private:
  void gather(std::span<const ReferencePart> parts);
  void frame();
  void fuse();
  void sort_by_cell();

  std::vector<SurfaceElement> points_;    ///< transformed, not yet fused
  std::vector<SurfaceElement> fused_;     ///< sums, in order of making
  std::vector<std::uint32_t> cell_of_;    ///< by fused element
  std::vector<std::int32_t> next_;        ///< linked list within a cell while fusing
  std::vector<std::int32_t> head_;        ///< by cell
  std::vector<std::uint32_t> start_;      ///< by cell: the first of its elements; one more than cells
  std::vector<SurfaceElement> elements_;  ///< ordered by cell
  float origin_x_ = 0, origin_y_ = 0;
  int columns_ = 0, rows_ = 0;
};

}  // namespace helicoid
