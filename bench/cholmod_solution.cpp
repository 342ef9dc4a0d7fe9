#include "bench/cholmod_solution.hpp"

#include <cholmod.h>

#include <algorithm>
#include <ctime>

namespace helicoid {

namespace {

/// The library's workspace, for as long as it is needed.
class Cholmod {
 public:
  explicit Cholmod(CholmodMode mode) {
    cholmod_start(&common_);
    common_.supernodal = mode == CholmodMode::automatic    ? CHOLMOD_AUTO
                         : mode == CholmodMode::simplicial ? CHOLMOD_SIMPLICIAL
                                                           : CHOLMOD_SUPERNODAL;
    common_.print = 0;
  }
  ~Cholmod() {
    cholmod_free_sparse(&matrix_, &common_);
    cholmod_free_factor(&factor_, &common_);
    cholmod_finish(&common_);
  }
  Cholmod(const Cholmod&) = delete;
  Cholmod& operator=(const Cholmod&) = delete;

  /// The lower half of H, scalar by scalar.
  void take(const BlockMatrix& H) {
    const auto scalars = kBlock * static_cast<std::size_t>(H.nodes());
    const std::size_t entries = 6 * static_cast<std::size_t>(H.nodes()) + 9 * H.row.size();
    matrix_ = cholmod_allocate_sparse(scalars, scalars, entries, 1, 1, -1, CHOLMOD_REAL, &common_);
    auto* first = static_cast<int*>(matrix_->p);
    auto* row = static_cast<int*>(matrix_->i);
    auto* value = static_cast<double*>(matrix_->x);
    int at = 0;
    for (std::int32_t node = 0; node < H.nodes(); ++node) {
      for (int j = 0; j < kBlock; ++j) {
        first[kBlock * node + j] = at;
        const auto put = [&](std::int32_t block_row, const double* block, int from) {
          for (int i = from; i < kBlock; ++i, ++at) {
            row[at] = kBlock * block_row + i;
            value[at] = block[i + kBlock * j];
          }
        };
        put(node, H.diagonal.data() + 9 * static_cast<std::size_t>(node), j);
        for (std::size_t e = H.first[node]; e < H.first[node + 1]; ++e) put(H.row[e], H.below.data() + 9 * e, 0);
      }
    }
    first[scalars] = at;
  }

  void order() { factor_ = cholmod_analyze(matrix_, &common_); }
  void factorise() { cholmod_factorize(matrix_, factor_, &common_); }

  std::vector<double> solve(const std::vector<double>& right) {
    cholmod_dense* b = cholmod_allocate_dense(right.size(), 1, right.size(), CHOLMOD_REAL, &common_);
    std::copy(right.begin(), right.end(), static_cast<double*>(b->x));
    cholmod_dense* x = cholmod_solve(CHOLMOD_A, factor_, b, &common_);
    const auto* values = static_cast<const double*>(x->x);
    std::vector<double> result(values, values + right.size());
    cholmod_free_dense(&b, &common_);
    cholmod_free_dense(&x, &common_);
    return result;
  }

 private:
  cholmod_common common_{};
  cholmod_sparse* matrix_ = nullptr;
  cholmod_factor* factor_ = nullptr;
};

/// Of all threads: CHOLMOD and the BLAS beneath it may use several.
template <class Work>
double cpu_seconds(Work&& work) {
  const auto now = [] {
    timespec time{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  };
  const double began = now();
  work();
  return now() - began;
}

}  // namespace

CholmodSolution solve_by_cholmod(const BlockMatrix& H, std::span<const std::vector<double>> rights, CholmodMode mode) {
  Cholmod cholmod(mode);
  cholmod.take(H);
  CholmodSolution solution;
  solution.order_s = cpu_seconds([&] { cholmod.order(); });
  solution.factorise_s = cpu_seconds([&] { cholmod.factorise(); });
  solution.solve_s = cpu_seconds([&] {
    for (const std::vector<double>& right : rights) solution.columns.push_back(cholmod.solve(right));
  });
  return solution;
}

}  // namespace helicoid
