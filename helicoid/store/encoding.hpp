// How Helicoid's own tables hold what is measured: to the bit, and small. Everything derived is left out.
#pragma once

#include <optional>

#include "helicoid/manifold/map.hpp"
#include "helicoid/store/blob.hpp"

namespace helicoid::store {

void encode(BlobWriter& blob, const LaserModel& laser);
[[nodiscard]] LaserModel decode_laser(BlobReader& blob);

void encode(BlobWriter& blob, const TrackedScan& scan);
[[nodiscard]] TrackedScan decode_tracked_scan(BlobReader& blob);

/// Ranges that are whole centimetres, as most lasers report them, take two bytes each; others their four.
void encode(BlobWriter& blob, const Scan& scan);
[[nodiscard]] Scan decode_scan(BlobReader& blob);

/// All of a relation but its patches and its kind, which are columns.
void encode(BlobWriter& blob, const Relation& relation);
[[nodiscard]] Relation decode_relation(BlobReader& blob);

}  // namespace helicoid::store
