#pragma once

#include "mechanics/numbers.hpp"

/// Isotropic laws at a point, written once for one number and for packs of them: P is a double or a pack. The
/// displacement gradient H = grad u, F = I + H and stresses are [3*i + J], moduli dP_iJ/dF_kL; strains from
/// F - I would lose the digits of small displacements. A law is a type with
///   stress(H, parameters, P)       the first Piola-Kirchhoff stress without the pressure, MPa,
///   moduli(H, parameters, A)       its derivative,
///   pressure(J - 1, parameters)    tension-positive mean Cauchy stress, MPa, and its slope,
///   dilatation(p, parameters)      its inverse,
///   energy(H, parameters)          without that of the pressure, and
///   volume_energy(J - 1, parameters)  the pressure's integral, N mm per mm³ at rest;
///   Moduli                         Full, or Upper where they are symmetric,
///   is_finite                      J = det F; else J = 1 + tr H, and areas do not turn,
///   has_pressure                   P = stress + p(J - 1) cof F; else P = stress, and the
///                                  three functions for the pressure are absent,
///   Material                       the one of a case's materials that it is made from.
namespace springproof::cases {
struct LinearElastic;
struct Ogden;
struct Yeoh;
} // namespace springproof::cases

namespace springproof::mechanics {

/// Where dP_r/dF_s lies: all 81, or the upper triangle of symmetric ones.
struct Full {
  static constexpr bool is_symmetric = false;
  static constexpr int n = 81;
  static constexpr int at(int r, int s) { return 9 * r + s; }
};
struct Upper {
  static constexpr bool is_symmetric = true;
  static constexpr int n = 45;
  static constexpr int at(int r, int s) {
    return r <= s ? 9 * r - r * (r - 1) / 2 + s - r : 9 * s - s * (s - 1) / 2 + r - s;
  }
};

/// What parameters_of() makes of a material: mu, kappa; Ogden's: kappa, then mu and alpha of every term;
/// Yeoh's: kappa, c10, c20, c30.
template<class P>
struct Parameters {
  static constexpr int most = 17; ///< Ogden's with eight terms
  P value[most];
  int n;
};

/// A function's value and its derivative.
template<class P>
struct ValueAndSlope {
  P value, slope;
};

/// F = I + H
template<class P>
SPRINGPROOF_INLINE void deformation_gradient(const P (&h)[9], P (&f)[9]) {
  for (int e = 0; e < 9; ++e) f[e] = e % 4 == 0 ? h[e] + 1 : h[e];
}

/// H + H^T + H^T H, twice Green's strain, whose digits F^T F - I would lose: xx, yy, zz, yz, xz, xy.
template<class P>
SPRINGPROOF_INLINE void twice_green_strain(const P (&h)[9], P (&c)[6]) {
  for (int a = 0; a < 3; ++a) {
    const int b = (a + 1) % 3, d = (a + 2) % 3;
    c[a] = 2 * h[4 * a] + (h[a] * h[a] + h[3 + a] * h[3 + a] + h[6 + a] * h[6 + a]);
    c[3 + a] = h[3 * b + d] + h[3 * d + b] + (h[b] * h[d] + h[3 + b] * h[3 + d] + h[6 + b] * h[6 + d]);
  }
}

/// P = F S for a symmetric second Piola-Kirchhoff stress S.
template<class P>
SPRINGPROOF_INLINE void first_stress(const P (&h)[9], const P (&s)[9], P (&stress)[9]) {
  P f[9];
  deformation_gradient(h, f);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      stress[3 * i + j] = f[3 * i] * s[j] + f[3 * i + 1] * s[3 + j] + f[3 * i + 2] * s[6 + j];
}

template<class P>
SPRINGPROOF_INLINE P determinant(const P (&f)[9]) {
  return f[0] * (f[4] * f[8] - f[5] * f[7]) + f[1] * (f[5] * f[6] - f[3] * f[8]) +
         f[2] * (f[3] * f[7] - f[4] * f[6]);
}

/// cof F = dJ/dF.
template<class P>
SPRINGPROOF_INLINE void cofactor(const P (&f)[9], P (&c)[9]) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const int k = (i + 1) % 3, m = (i + 2) % 3, a = (j + 1) % 3, b = (j + 2) % 3;
      c[3 * i + j] = f[3 * k + a] * f[3 * m + b] - f[3 * k + b] * f[3 * m + a];
    }
}

/// moduli += factor * d(cof F)_iJ/dF_kL = factor * eps_ikm eps_JLN F_mN
template<class M, class P>
SPRINGPROOF_INLINE void add_cofactor_derivative(const P (&f)[9], const P& factor, P (&moduli)[M::n]) {
  for (int i = 0; i < 3; ++i) {
    const int k = (i + 1) % 3, m = (i + 2) % 3; // eps_ikm = 1, eps_imk = -1
    for (int a = 0; a < 3; ++a) {
      const int b = (a + 1) % 3, c = (a + 2) % 3;
      const auto add_to = [&](int r, int s, const P& value) {
        if (!M::is_symmetric || r <= s) moduli[M::at(r, s)] += value;
      };
      add_to(3 * i + a, 3 * k + b, factor * f[3 * m + c]);
      add_to(3 * i + a, 3 * k + c, -factor * f[3 * m + b]);
      add_to(3 * i + a, 3 * m + b, -factor * f[3 * k + c]);
      add_to(3 * i + a, 3 * m + c, factor * f[3 * k + b]);
    }
  }
}

/// det(I + H) - 1, the sum of H's invariants.
template<class P>
SPRINGPROOF_INLINE P growth_of(const P (&h)[9]) {
  P c[9];
  cofactor(h, c);
  return h[0] + h[4] + h[8] + (c[0] + c[4] + c[8]) + determinant(h);
}

} // namespace springproof::mechanics
