#pragma once

#include "mechanics/laws/point.hpp"

namespace springproof::mechanics {

/// Eigenvalues a[0..2] and eigenvectors (columns of v) of the symmetric matrix xx, yy, zz, yz, xz, xy, by
/// Jacobi's rotations; the vectors are orthonormal to rounding error even where eigenvalues coincide.
template<class P>
SPRINGPROOF_INLINE void rotate(P& app, P& aqq, P& apq, P& apr, P& aqr, P (&v)[9], int p, int q) {
  constexpr double tiny = sizeof(RealOf<P>) == 8 ? 1e-300 : 1e-36;
  const P d = aqq - app, twice = apq + apq, length = root(d * d + twice * twice) + constant<P>(tiny);
  const P t = twice / (d < P{} ? d - length : d + length);
  const P c = 1 / root(1 + t * t), s = t * c;
  app -= t * apq;
  aqq += t * apq;
  apq = P{};
  const P before = apr;
  apr = c * before - s * aqr;
  aqr = s * before + c * aqr;
  for (int i = 0; i < 3; ++i) {
    const P vp = v[3 * i + p];
    v[3 * i + p] = c * vp - s * v[3 * i + q];
    v[3 * i + q] = s * vp + c * v[3 * i + q];
  }
}
template<class P>
SPRINGPROOF_INLINE void eigensystem(P (&a)[6], P (&v)[9]) {
  for (int i = 0; i < 9; ++i) v[i] = constant<P>(i % 4 == 0 ? 1 : 0);
  constexpr double relative = sizeof(RealOf<P>) == 8 ? 1e-32 : 1e-14; // squared
  constexpr double least = sizeof(RealOf<P>) == 8 ? 1e-300 : 1e-36;   // bound for the zero matrix
  const P squared = a[0] * a[0] + a[1] * a[1] + a[2] * a[2] + 2 * (a[3] * a[3] + a[4] * a[4] + a[5] * a[5]);
  const P small = constant<P>(relative) * squared + constant<P>(least);
  for (int sweep = 0; sweep < 8; ++sweep) {
    if (all_greater(small, a[3] * a[3] + a[4] * a[4] + a[5] * a[5])) break;
    rotate(a[0], a[1], a[5], a[4], a[3], v, 0, 1);
    rotate(a[0], a[2], a[4], a[5], a[3], v, 0, 2);
    rotate(a[1], a[2], a[3], a[5], a[4], v, 1, 2);
  }
}

/// Finds the stretches' squares, axes in the material, and logarithms.
template<class P>
SPRINGPROOF_INLINE void principal_axes(const P (&h)[9], P (&squared)[3], P (&axes)[9], P (&x)[3]) {
  P c[6];
  twice_green_strain(h, c);
  eigensystem(c, axes);
  for (int a = 0; a < 3; ++a) {
    squared[a] = 1 + c[a];
    x[a] = log1p_of(c[a]) / 2;
  }
}

/// An isotropic law given in principal axes. With F = sum lambda_i n_i x N_i and P_i = tau_i/lambda_i the
/// only entries of A = dP/dF in the axes n, N are
///   A_iijj = dP_i/d lambda_j,   A_ijij = m_ij,   A_ijji = (lambda_j² m_ij - tau_j)/(lambda_i lambda_j),
/// m_ij = (tau_i - tau_j)/(lambda_i² - lambda_j²) (i != j), which stay exact when stretches coincide as long
/// as m_ij does.
/// @tparam Principal  has, for logarithmic stretches x_i = ln lambda_i,
///   kirchhoff(x, parameters, tau)  the part of the Kirchhoff stress that is no pressure, MPa,
///   slopes(x, lambda², parameters, slope, difference)  d tau_i/d x_j, and m_ij for the pairs (1,2), (2,0),
///                                  (0,1), at its limit when the stretches coincide,
///   energy(x, parameters)          and what every law has of the pressure
template<class Principal>
struct InPrincipalStretches : Principal {
  static constexpr bool is_finite = true, has_pressure = true;
  using M = typename Principal::Moduli;
  using Moduli = M;

  /// P = F S, S = sum tau_i/lambda_i² N_i x N_i.
  template<class P>
  SPRINGPROOF_INLINE static void stress(const P (&h)[9], const Parameters<P>& m, P (&stress)[9]) {
    P squared[3], axes[9], x[3], tau[3], s[9];
    principal_axes(h, squared, axes, x);
    Principal::kirchhoff(x, m, tau);
    for (int i = 0; i < 3; ++i) tau[i] /= squared[i];
    for (int a = 0; a < 3; ++a)
      for (int b = a; b < 3; ++b)
        s[3 * a + b] = s[3 * b + a] = tau[0] * axes[3 * a] * axes[3 * b] +
                                      tau[1] * axes[3 * a + 1] * axes[3 * b + 1] +
                                      tau[2] * axes[3 * a + 2] * axes[3 * b + 2];
    first_stress(h, s, stress);
  }

  template<class P>
  SPRINGPROOF_INLINE static void moduli(const P (&h)[9], const Parameters<P>& m, P (&moduli)[M::n]) {
    P squared[3], material[9], x[3], tau[3], slope[9], difference[3], inverse[3], spatial[9], f[9];
    principal_axes(h, squared, material, x);
    deformation_gradient(h, f);
    Principal::kirchhoff(x, m, tau);
    Principal::slopes(x, squared, m, slope, difference);
    for (int i = 0; i < 3; ++i) inverse[i] = 1 / root(squared[i]);
    for (int a = 0; a < 3; ++a)
      for (int i = 0; i < 3; ++i)
        spatial[3 * a + i] =
            (f[3 * a] * material[i] + f[3 * a + 1] * material[3 + i] + f[3 * a + 2] * material[6 + i]) *
            inverse[i];
    P along[9], crossed[3]; // entries of the tangent in the axes
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        along[3 * i + j] = (i == j ? slope[4 * i] - tau[i] : slope[3 * i + j]) * inverse[i] * inverse[j];
    for (int p = 0; p < 3; ++p) {
      const int i = (p + 1) % 3, j = (p + 2) % 3;
      crossed[p] = (squared[j] * difference[p] - tau[j]) * inverse[i] * inverse[j];
    }
    P axes[9][9]; // [a, B][i, j] = n_i x N_j
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b)
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j) axes[3 * a + b][3 * i + j] = spatial[3 * a + i] * material[3 * b + j];
    for (int r = 0; r < 9; ++r) {
      P half[9];
      for (int j = 0; j < 3; ++j)
        half[4 * j] = axes[r][0] * along[j] + axes[r][4] * along[3 + j] + axes[r][8] * along[6 + j];
      for (int p = 0; p < 3; ++p) {
        const int i = (p + 1) % 3, j = (p + 2) % 3;
        half[3 * i + j] = axes[r][3 * i + j] * difference[p] + axes[r][3 * j + i] * crossed[p];
        half[3 * j + i] = axes[r][3 * j + i] * difference[p] + axes[r][3 * i + j] * crossed[p];
      }
      for (int s = M::is_symmetric ? r : 0; s < 9; ++s) {
        P sum = half[0] * axes[s][0];
        for (int c = 1; c < 9; ++c) sum += half[c] * axes[s][c];
        moduli[M::at(r, s)] = sum;
      }
    }
  }

  template<class P>
  SPRINGPROOF_INLINE static P energy(const P (&h)[9], const Parameters<P>& m) {
    P squared[3], axes[9], x[3];
    principal_axes(h, squared, axes, x);
    return Principal::energy(x, m);
  }
};

} // namespace springproof::mechanics
