// The assignment problem: who does what, so that the sum of costs is least (Kuhn 1955, Munkres 1957).
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace helicoid {

/// By row the column that it gets; each column goes to one row at most. An infinite cost forbids a pair; as many rows
/// as can get a column do, and among those choices the sum of costs is least. Costs are not NaN.
[[nodiscard]] std::vector<std::optional<std::size_t>> optimal_assignment(const Eigen::MatrixXd& cost);

}  // namespace helicoid
