// Who walks ahead of a robot in a bare corridor is all that is seen along it.
#pragma once

#include "helicoid/align/align_scan.hpp"

namespace helicoid {

/// True if all the points that lie on a surface of the reference where the scan stands at `T_told`, but on none where
/// it stands at `T_expected`, are within `extent` (metres) of one another: one thing tells the difference, no larger
/// than a person or a robot, and that may have moved. Also if there are none.
[[nodiscard]] bool is_told_by_one_thing(const Reference& reference, const ScanPoints& scan, const Pose2& T_expected,
                                        const Pose2& T_told, double extent = 0.8, const AlignOptions& options = {});

}  // namespace helicoid
