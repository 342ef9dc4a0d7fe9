// Linear systems solved by CHOLMOD, as a judge of our own factorisation. CHOLMOD's supernodal part is under the GPL:
// only tests and judges link it, which are built but never installed.
#pragma once

#include <span>
#include <vector>

#include "helicoid/fit/block_cholesky.hpp"

namespace helicoid {

enum class CholmodMode : std::uint8_t { automatic, simplicial, supernodal };

struct CholmodSolution {
  std::vector<std::vector<double>> columns;  ///< one a right side
  double order_s = 0;                        ///< CPU: ordering and symbolic phase
  double factorise_s = 0;
  double solve_s = 0;  ///< of all right sides

  [[nodiscard]] double total_s() const { return order_s + factorise_s + solve_s; }
};

/// H x = right for each right side, H positive definite; ordered by whatever CHOLMOD finds best of AMD and METIS.
[[nodiscard]] CholmodSolution solve_by_cholmod(const BlockMatrix& H, std::span<const std::vector<double>> rights,
                                               CholmodMode mode = CholmodMode::automatic);

}  // namespace helicoid
