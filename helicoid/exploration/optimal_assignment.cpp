#include "helicoid/exploration/optimal_assignment.hpp"

#include <cmath>
#include <limits>

namespace helicoid {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Shortest augmenting paths with potentials: rows are taken in one by one. Rows <= columns; everything finite.
/// Row and column 0 are the path's ends; others count from 1.
class ShortestAugmentation {
 public:
  explicit ShortestAugmentation(const Eigen::MatrixXd& cost)
      : cost_(cost),
        rows_(static_cast<std::size_t>(cost.rows())),
        columns_(static_cast<std::size_t>(cost.cols())),
        of_row_(rows_ + 1, 0),
        of_column_(columns_ + 1, 0),
        row_at_(columns_ + 1, 0),
        before_(columns_ + 1, 0) {
    for (std::size_t row = 1; row <= rows_; ++row) take_in(row);
  }
  /// By column, from 1: its row, from 1; 0: none.
  [[nodiscard]] const std::vector<std::size_t>& row_at() const { return row_at_; }

 private:
  void take_in(std::size_t row) {
    row_at_[0] = row;
    std::size_t column = 0;
    std::vector<double> least(columns_ + 1, kInfinity);
    std::vector<bool> done(columns_ + 1, false);
    do {
      column = advance(column, least, done);
    } while (row_at_[column] != 0);
    for (; column != 0; column = before_[column]) row_at_[column] = row_at_[before_[column]];
  }
  std::size_t advance(std::size_t column, std::vector<double>& least, std::vector<bool>& done) {
    done[column] = true;
    const std::size_t row = row_at_[column];
    double step = kInfinity;
    std::size_t next = 0;
    for (std::size_t j = 1; j <= columns_; ++j) {
      if (done[j]) continue;
      const double reduced =
          cost_(static_cast<Eigen::Index>(row - 1), static_cast<Eigen::Index>(j - 1)) - of_row_[row] - of_column_[j];
      if (reduced < least[j]) {
        least[j] = reduced;
        before_[j] = column;
      }
      if (least[j] < step) {
        step = least[j];
        next = j;
      }
    }
    for (std::size_t j = 0; j <= columns_; ++j) {
      if (done[j]) {
        of_row_[row_at_[j]] += step;
        of_column_[j] -= step;
      } else {
        least[j] -= step;
      }
    }
    return next;
  }

  const Eigen::MatrixXd& cost_;
  std::size_t rows_, columns_;
  std::vector<double> of_row_, of_column_;  ///< potentials
  std::vector<std::size_t> row_at_, before_;
};

/// Forbidden pairs become so dear that one of them outweighs all else.
Eigen::MatrixXd made_finite(const Eigen::MatrixXd& cost) {
  double largest = 1;
  for (const double c : cost.reshaped()) {
    if (std::isfinite(c)) largest = std::max(largest, std::abs(c));
  }
  const double dear = 4 * largest * static_cast<double>(std::min(cost.rows(), cost.cols()) + 1);
  return cost.unaryExpr([&](double c) { return std::isfinite(c) ? c : dear; });
}

}  // namespace

std::vector<std::optional<std::size_t>> optimal_assignment(const Eigen::MatrixXd& cost) {
  std::vector<std::optional<std::size_t>> column_of(static_cast<std::size_t>(cost.rows()));
  if (cost.size() == 0) return column_of;
  const Eigen::MatrixXd finite = made_finite(cost);
  const bool wide = cost.rows() <= cost.cols();
  const Eigen::MatrixXd upright = wide ? finite : Eigen::MatrixXd(finite.transpose());
  const ShortestAugmentation solved(upright);
  for (std::size_t j = 1; j < solved.row_at().size(); ++j) {
    if (solved.row_at()[j] == 0) continue;
    const std::size_t row = wide ? solved.row_at()[j] - 1 : j - 1;
    const std::size_t column = wide ? j - 1 : solved.row_at()[j] - 1;
    if (std::isfinite(cost(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column)))) column_of[row] = column;
  }
  return column_of;
}

}  // namespace helicoid
