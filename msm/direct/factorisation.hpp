#pragma once

#include "msm/problem.hpp"
#include "msm/tangent.hpp"

#include <Eigen/CholmodSupport>
#include <algorithm>
#include <limits>
#include <new>
#include <vector>
#ifdef _OPENMP
#include <omp.h>
#endif

namespace springproof::msm {

#ifndef _OPENMP // as in the sanitized build
inline void omp_set_max_active_levels(int) {}
inline int omp_get_max_active_levels() {
  return 1;
}
#endif

/// While it lives, OpenMP's parallel regions have one thread. CHOLMOD asks for four of its own accord,
/// whatever OMP_NUM_THREADS says; on two cores that took three to five times as long as one.
class OneThread {
 public:
  OneThread() { omp_set_max_active_levels(0); }
  ~OneThread() { omp_set_max_active_levels(before_); }
  OneThread(const OneThread&) = delete;
  OneThread& operator=(const OneThread&) = delete;

 private:
  int before_ = omp_get_max_active_levels();
};

/// CHOLMOD with METIS' nested dissection, which on lattices of cells fills in a third of what minimum degree
/// does.
class Factorisation : Eigen::CholmodSupernodalLLT<Tangent::Matrix, Eigen::Lower> {
 public:
  Factorisation() {
    cholmod().nmethods = 1;
    cholmod().method[0].ordering = CHOLMOD_METIS;
    cholmod().print = 0;
  }

  void analyse(const Tangent::Matrix& matrix) {
    analyzePattern(matrix);
    check();
  }
  /// @return whether matrix + shift is positive definite
  bool factorise(const Tangent::Matrix& matrix, double shift) {
    setShift(shift);
    factorize(matrix);
    check();
    return info() == Eigen::Success;
  }
  Vector solve(const Vector& right_side) {
    Vector solution = CholmodSupernodalLLT::solve(right_side);
    check();
    return solution;
  }

  /// Calls action(first column, columns as a matrix, their rows' numbers) for the blocks of columns of the
  /// factor that have the same rows below them; the first rows are those of the columns themselves.
  template<class Action>
  void for_each_block(const Action& action) const {
    const cholmod_factor& factor = *m_cholmodFactor;
    const auto *super = static_cast<const int*>(factor.super), *pi = static_cast<const int*>(factor.pi),
               *px = static_cast<const int*>(factor.px), *rows = static_cast<const int*>(factor.s);
    const auto* values = static_cast<const double*>(factor.x);
    for (std::size_t s = 0; s < factor.nsuper; ++s) {
      const Eigen::Map<const Eigen::MatrixXd> columns(values + px[s], pi[s + 1] - pi[s],
                                                      super[s + 1] - super[s]);
      action(super[s], columns, rows + pi[s]);
    }
  }
  /// The unknown that is at a place of the factor.
  std::vector<int> permutation() const {
    const auto* first = static_cast<const int*>(m_cholmodFactor->Perm);
    return {first, first + m_cholmodFactor->n};
  }

  /// The smallest of pivot over diagonal entry: how much of a diagonal entry elimination leaves. Rounding
  /// leaves about 1e-16 where nothing should be left.
  double smallest_pivot_ratio(const Vector& diagonal) const {
    const cholmod_factor& factor = *m_cholmodFactor;
    const auto *super = static_cast<const int*>(factor.super), *pi = static_cast<const int*>(factor.pi),
               *px = static_cast<const int*>(factor.px), *permutation = static_cast<const int*>(factor.Perm);
    const auto* values = static_cast<const double*>(factor.x);
    double smallest = std::numeric_limits<double>::infinity();
    for (std::size_t s = 0; s < factor.nsuper; ++s) {
      const int n_rows = pi[s + 1] - pi[s];
      for (int column = super[s]; column < super[s + 1]; ++column) {
        const double root = values[px[s] + (column - super[s]) * (n_rows + 1)];
        smallest = std::min(smallest, root * root / diagonal[permutation[column]]);
      }
    }
    return smallest;
  }

 private:
  /// Eigen takes a factor that was not computed for want of memory for a success.
  void check() {
    if (cholmod().status == CHOLMOD_OUT_OF_MEMORY || cholmod().status == CHOLMOD_TOO_LARGE)
      throw std::bad_alloc();
  }
};

} // namespace springproof::msm
