// Part of kernels_source.hpp, in its namespace: bubbles of cells and their condensation. A bubble's component
// has entry 3*bubble + component.
#pragma once

template<class P>
using Bubbles = P[9];

/// Adds the gradient of the bubbles' displacement.
template<class P>
SPRINGPROOF_INLINE void add_bubble_gradient(const Cells& cells, int q, const Bubbles<P>& b, P (&h)[9]) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) h[3 * i + j] += b[3 * j + i] * static_cast<RealOf<P>>(cells.bubbles[q][j]);
}

/// force += (stress . gradient of each bubble)
template<class P>
SPRINGPROOF_INLINE void add_bubble_force(const Cells& cells, int q, const P (&stress)[9], Bubbles<P>& force) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      force[3 * j + i] += stress[3 * i + j] * static_cast<RealOf<P>>(cells.bubbles[q][j]);
}

template<class P>
struct BubbleStiffness {
  P own[9][9] = {};           ///< K_bb
  P on_corners[8][3][9] = {}; ///< forces on corners by bubbles: [corner][component][bubble]
};

/// Adds the stiffness of the bubbles at a Gauss point.
template<class M, class P>
SPRINGPROOF_INLINE void add_own(const Cells& cells, int q, const P (&moduli)[M::n], P (&own)[9][9]) {
  using Real = RealOf<P>;
  for (int j = 0; j < 3; ++j)
    for (int l = 0; l < 3; ++l) {
      const Real factor = static_cast<Real>(cells.bubbles[q][j] * cells.bubbles[q][l]);
      for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) own[3 * j + i][3 * l + k] += moduli[M::at(3 * i + j, 3 * k + l)] * factor;
    }
}

/// Forces on corners by bubbles, or on bubbles by corners.
enum class Coupling { on_corners, on_bubbles };

/// coupling[corner][component][bubble's component] += grad N . moduli . gradient of the bubble
template<class M, Coupling of, class P>
SPRINGPROOF_INLINE void add_coupling(const Cells& cells, int q, const P (&moduli)[M::n],
                                     P (&coupling)[8][3][9]) {
  using Real = RealOf<P>;
#pragma GCC unroll 1
  for (int b = 0; b < 9; ++b) {
    const int s = 3 * (b % 3) + b / 3;
    const Real slope = static_cast<Real>(cells.bubbles[q][b / 3]);
    P right[9];
    for (int r = 0; r < 9; ++r)
      right[r] = slope * moduli[of == Coupling::on_corners ? M::at(r, s) : M::at(s, r)];
    for (int a = 0; a < 8; ++a)
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          coupling[a][i][b] += right[3 * i + j] * static_cast<Real>(cells.gradients[q][a][j]);
  }
}

/// Replaces a matrix by its factors L and U, without pivoting: at rest it is positive definite, and it stays
/// nearly symmetric. U's diagonal is inverted.
template<class P>
SPRINGPROOF_INLINE void factorise(P (&matrix)[9][9]) {
#pragma GCC unroll 1
  for (int k = 0; k < 9; ++k) {
    matrix[k][k] = 1 / matrix[k][k];
    for (int r = k + 1; r < 9; ++r) {
      const P factor = matrix[r][k] * matrix[k][k];
      matrix[r][k] = factor;
      for (int s = k + 1; s < 9; ++s) matrix[r][s] -= factor * matrix[k][s];
    }
  }
}

template<class P>
SPRINGPROOF_INLINE void solve(const P (&factors)[9][9], Bubbles<P>& x) {
  for (int r = 1; r < 9; ++r)
    for (int s = 0; s < r; ++s) x[r] -= factors[r][s] * x[s];
  for (int r = 8; r >= 0; --r) {
    for (int s = r + 1; s < 9; ++s) x[r] -= factors[r][s] * x[s];
    x[r] *= factors[r][r];
  }
}
