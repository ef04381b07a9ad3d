#pragma once

#include "mechanics/grid/field.hpp"

namespace springproof::mechanics::grid {

/// out = keep * out + factor * (blocks) in
/// @param blocks  symmetric 3x3 blocks, one for each node: six arrays xx, yy, zz, yz, xz, xy
inline void apply_blocks(const float* blocks, const Field<float>& in, Field<float>& out, float keep,
                         float factor, int n_threads) {
  const std::ptrdiff_t n = in.size() / 3;
  for_each_piece(n, n_threads, [&](std::ptrdiff_t first, std::ptrdiff_t length) {
    apply_blocks(blocks + first, in.data() + first, out.data() + first, n, keep, factor, length);
  });
}

/// What Chebyshev's iteration works on: eigenvalues of the preconditioned matrix up to a bound, and down to a
/// part of it.
struct Chebyshev {
  int degree;   ///< of the polynomial
  double share; ///< upper bound over the lower one
};

/// Chebyshev's iteration (Adams, Brezina, Hu, Tuminaro 2003) on a solution and its residual.
/// @param upper           bound of the eigenvalues
/// @param precondition    (keep, factor): correction = keep * correction + factor * (preconditioned residual)
/// @param correct         (keeps_residual): adds the correction to the solution and, where that is wanted,
///                        takes its product from the residual
/// @param keeps_residual  after the last step too
template<class Precondition, class Correct>
void smooth(const Chebyshev& chebyshev, double upper, const Precondition& precondition,
            const Correct& correct, bool keeps_residual) {
  const double lower = upper / chebyshev.share;
  const double centre = (upper + lower) / 2, half_width = (upper - lower) / 2;
  const double sigma = centre / half_width;
  double rho = 1 / sigma;
  precondition(0.0f, static_cast<float>(1 / centre));
  for (int step = 1;; ++step) {
    correct(keeps_residual || step < chebyshev.degree);
    if (step == chebyshev.degree) return;
    const double next = 1 / (2 * sigma - rho);
    precondition(static_cast<float>(next * rho), static_cast<float>(2 * next / half_width));
    rho = next;
  }
}

/// solution = cycle(right_side), of a cycle in single precision that is linear: it takes `residual` to
/// `answer`. The right side is divided by its norm, which keeps single precision in range.
template<class Cycle>
void apply_in_single_precision(const Field<double>& right_side, double norm, Field<float>& residual,
                               const Field<float>& answer, Field<double>& solution, const Cycle& cycle,
                               int n_threads) {
  if (!(norm > 0)) {
    solution.setZero();
    return;
  }
  for_each_piece(right_side.size(), n_threads, [&](std::ptrdiff_t first, std::ptrdiff_t n) {
    residual.segment(first, n) = (right_side.segment(first, n) / norm).cast<float>();
  });
  cycle();
  for_each_piece(right_side.size(), n_threads, [&](std::ptrdiff_t first, std::ptrdiff_t n) {
    solution.segment(first, n) = norm * answer.segment(first, n).cast<double>();
  });
}

} // namespace springproof::mechanics::grid
