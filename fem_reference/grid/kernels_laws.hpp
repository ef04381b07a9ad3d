// Part of kernels_source.hpp, in its namespace: the laws of fem_reference/laws and mechanics/laws, a pack of
// points at a time. P is a pack; H = grad u, F = I + H and stresses are [3*i + J], moduli dP_iJ/dF_kL.
#pragma once

/// Where dP_r/dF_s lies: all 81, or the upper triangle of symmetric ones.
struct Full {
  static constexpr int n = 81;
  static constexpr int at(int r, int s) { return 9 * r + s; }
  static constexpr bool has(int, int) { return true; }
};
struct Upper {
  static constexpr int n = 45;
  static constexpr int at(int r, int s) {
    return r <= s ? 9 * r - r * (r - 1) / 2 + s - r : 9 * s - s * (s - 1) / 2 + r - s;
  }
  static constexpr bool has(int r, int s) { return r <= s; }
};

/// The parameters of a pack of cells.
template<class P>
struct Parameters {
  static constexpr int most = 17; ///< Ogden's with eight terms
  P value[most];
  int n;
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

template<class P>
struct Pressure {
  P value, slope;
};

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

/// moduli += factor * d(cof F)/dF
template<class M, class P>
SPRINGPROOF_INLINE void add_cofactor_derivative(const P (&f)[9], const P& factor, P (&moduli)[M::n]) {
  for (int i = 0; i < 3; ++i) {
    const int k = (i + 1) % 3, m = (i + 2) % 3;
    for (int a = 0; a < 3; ++a) {
      const int b = (a + 1) % 3, c = (a + 2) % 3;
      const auto add_to = [&](int r, int s, const P& value) {
        if (M::has(r, s)) moduli[M::at(r, s)] += value;
      };
      add_to(3 * i + a, 3 * k + b, factor * f[3 * m + c]);
      add_to(3 * i + a, 3 * k + c, -factor * f[3 * m + b]);
      add_to(3 * i + a, 3 * m + b, -factor * f[3 * k + c]);
      add_to(3 * i + a, 3 * m + c, factor * f[3 * k + b]);
    }
  }
}

struct SmallStrain {
  static constexpr bool is_finite = false, has_pressure = true;
  using Moduli = Upper;
  template<class P>
  SPRINGPROOF_INLINE static void stress(const P (&h)[9], const Parameters<P>& m, P (&stress)[9]) {
    const P mean = (h[0] + h[4] + h[8]) / 3;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        stress[3 * i + j] = m.value[0] * (h[3 * i + j] + h[3 * j + i] - (i == j ? 2 * mean : P{}));
  }
  template<class P>
  SPRINGPROOF_INLINE static void moduli(const P (&)[9], const Parameters<P>& m, P (&moduli)[Upper::n]) {
    for (int e = 0; e < Upper::n; ++e) moduli[e] = P{};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        moduli[Upper::at(3 * i + j, 3 * i + j)] += m.value[0];
        if (i <= j) moduli[Upper::at(3 * i + j, 3 * j + i)] += m.value[0];
        if (i <= j) moduli[Upper::at(4 * i, 4 * j)] -= m.value[0] * 2 / 3;
      }
  }
  template<class P>
  SPRINGPROOF_INLINE static Pressure<P> pressure(const P& dilatation, const Parameters<P>& m) {
    return {m.value[1] * dilatation, m.value[1]};
  }
  template<class P>
  SPRINGPROOF_INLINE static Pressure<P> dilatation(const P& p, const Parameters<P>& m) {
    return {p / m.value[1], 1 / m.value[1]};
  }
};

struct SaintVenantKirchhoff {
  static constexpr bool is_finite = true, has_pressure = false;
  using Moduli = Upper;
  template<class P>
  SPRINGPROOF_INLINE static void second(const P (&h)[9], const Parameters<P>& m, P (&s)[9]) {
    const P lambda = m.value[1] - m.value[0] * 2 / 3;
    P c[6];
    twice_green_strain(h, c);
    const P pressure = lambda * ((c[0] + c[1] + c[2]) / 2);
    for (int a = 0; a < 3; ++a) {
      const int b = (a + 1) % 3, d = (a + 2) % 3;
      s[4 * a] = m.value[0] * c[a] + pressure;
      s[3 * b + d] = s[3 * d + b] = m.value[0] * c[3 + a];
    }
  }
  template<class P>
  SPRINGPROOF_INLINE static void stress(const P (&h)[9], const Parameters<P>& m, P (&stress)[9]) {
    P s[9], f[9];
    second(h, m, s);
    deformation_gradient(h, f);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        stress[3 * i + j] = f[3 * i] * s[j] + f[3 * i + 1] * s[3 + j] + f[3 * i + 2] * s[6 + j];
  }
  template<class P>
  SPRINGPROOF_INLINE static void moduli(const P (&h)[9], const Parameters<P>& m, P (&moduli)[Upper::n]) {
    const P mu = m.value[0], lambda = m.value[1] - m.value[0] * 2 / 3;
    P s[9], f[9], left[9];
    second(h, m, s);
    deformation_gradient(h, f);
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k)
        left[3 * i + k] = f[3 * i] * f[3 * k] + f[3 * i + 1] * f[3 * k + 1] + f[3 * i + 2] * f[3 * k + 2];
    for (int i = 0; i < 3; ++i)
      for (int a = 0; a < 3; ++a)
        for (int k = 0; k < 3; ++k)
          for (int b = 0; b < 3; ++b) {
            const int r = 3 * i + a, t = 3 * k + b;
            if (r > t) continue;
            P value = lambda * f[r] * f[t] + mu * f[3 * i + b] * f[3 * k + a];
            if (i == k) value += s[3 * a + b];
            if (a == b) value += mu * left[3 * i + k];
            moduli[Upper::at(r, t)] = value;
          }
  }
  template<class P>
  SPRINGPROOF_INLINE static Pressure<P> pressure(const P&, const Parameters<P>&) {
    return {P{}, P{}};
  }
  template<class P>
  SPRINGPROOF_INLINE static Pressure<P> dilatation(const P&, const Parameters<P>&) {
    return {P{}, P{}};
  }
};

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
  constexpr double least = sizeof(RealOf<P>) == 8 ? 1e-300 : 1e-36;   // of the zero matrix
  const P squared = a[0] * a[0] + a[1] * a[1] + a[2] * a[2] + 2 * (a[3] * a[3] + a[4] * a[4] + a[5] * a[5]);
  const P small = constant<P>(relative) * squared + constant<P>(least);
  for (int sweep = 0; sweep < 8; ++sweep) {
    if (all_greater(small, a[3] * a[3] + a[4] * a[4] + a[5] * a[5])) break;
    rotate(a[0], a[1], a[5], a[4], a[3], v, 0, 1);
    rotate(a[0], a[2], a[4], a[5], a[3], v, 0, 2);
    rotate(a[1], a[2], a[3], a[5], a[4], v, 1, 2);
  }
}

/// An isotropic law in principal stretches: see laws/in_principal_stretches.hpp for the formulas.
template<class Principal>
struct InPrincipalStretches : Principal {
  static constexpr bool is_finite = true, has_pressure = true;
  using M = typename Principal::Moduli;
  using Moduli = M;

  /// Squares of the stretches, their axes in the material, their logarithms.
  template<class P>
  SPRINGPROOF_INLINE static void principal_axes(const P (&h)[9], P (&squared)[3], P (&axes)[9], P (&x)[3]) {
    P c[6];
    twice_green_strain(h, c);
    eigensystem(c, axes);
    for (int a = 0; a < 3; ++a) {
      squared[a] = 1 + c[a];
      x[a] = log1p_of(c[a]) / 2;
    }
  }

  /// P = F S, S = sum tau_i/lambda_i² N_i x N_i.
  template<class P>
  SPRINGPROOF_INLINE static void stress(const P (&h)[9], const Parameters<P>& m, P (&stress)[9]) {
    P squared[3], axes[9], x[3], tau[3], s[9], f[9];
    principal_axes(h, squared, axes, x);
    deformation_gradient(h, f);
    Principal::kirchhoff(x, m, tau);
    for (int i = 0; i < 3; ++i) tau[i] /= squared[i];
    for (int a = 0; a < 3; ++a)
      for (int b = a; b < 3; ++b)
        s[3 * a + b] = s[3 * b + a] = tau[0] * axes[3 * a] * axes[3 * b] +
                                      tau[1] * axes[3 * a + 1] * axes[3 * b + 1] +
                                      tau[2] * axes[3 * a + 2] * axes[3 * b + 2];
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        stress[3 * i + j] = f[3 * i] * s[j] + f[3 * i + 1] * s[3 + j] + f[3 * i + 2] * s[6 + j];
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
      for (int s = M::has(1, 0) ? 0 : r; s < 9; ++s) {
        P sum = half[0] * axes[s][0];
        for (int c = 1; c < 9; ++c) sum += half[c] * axes[s][c];
        moduli[M::at(r, s)] = sum;
      }
    }
  }
};

/// No energy belongs to it: its tangent is slightly unsymmetric.
struct LogStrain {
  using Moduli = Full;
  template<class P>
  SPRINGPROOF_INLINE static void kirchhoff(const P (&x)[3], const Parameters<P>& m, P (&tau)[3]) {
    const P sum = x[0] + x[1] + x[2], two_mu_j = 2 * m.value[0] * exp_of(sum);
    for (int i = 0; i < 3; ++i) tau[i] = two_mu_j * (x[i] - sum / 3);
  }
  template<class P>
  SPRINGPROOF_INLINE static void slopes(const P (&x)[3], const P (&squared)[3], const Parameters<P>& m,
                                        P (&slope)[9], P (&difference)[3]) {
    const P sum = x[0] + x[1] + x[2], two_mu_j = 2 * m.value[0] * exp_of(sum);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        slope[3 * i + j] = two_mu_j * (x[i] - sum / 3 + constant<P>((i == j ? 1. : 0.) - 1. / 3));
    for (int p = 0; p < 3; ++p) {
      const int i = (p + 1) % 3, j = (p + 2) % 3;
      // (x_i - x_j)/(lambda_i² - lambda_j²) = d/(2 sinh d)/(lambda_i lambda_j)
      const P d = x[i] - x[j], square = d * d;
      const P series = 1 - square / 6 * (1 - 7 * square / 60 * (1 - 31 * square / 294));
      const P direct = (d + d) * root(squared[i] * squared[j]) /
                       (absolute(d) > constant<P>(0.1) ? squared[i] - squared[j] : constant<P>(1));
      const P ratio = absolute(d) > constant<P>(0.1) ? direct : series;
      difference[p] = two_mu_j * ratio / (2 * root(squared[i] * squared[j]));
    }
  }
  template<class P>
  SPRINGPROOF_INLINE static Pressure<P> pressure(const P& dilatation, const Parameters<P>& m) {
    return {m.value[1] * log1p_of(dilatation), m.value[1] / (1 + dilatation)};
  }
  template<class P>
  SPRINGPROOF_INLINE static Pressure<P> dilatation(const P& p, const Parameters<P>& m) {
    const P change = expm1_of(p / m.value[1]);
    return {change, (1 + change) / m.value[1]};
  }
};

struct Ogden {
  using Moduli = Upper;
  template<class P>
  SPRINGPROOF_INLINE static void kirchhoff(const P (&x)[3], const Parameters<P>& m, P (&tau)[3]) {
    const P mean = (x[0] + x[1] + x[2]) / 3;
    for (int i = 0; i < 3; ++i) tau[i] = P{};
    for (int t = 1; t < m.n; t += 2) {
      const P mu = m.value[t], alpha = m.value[t + 1];
      P excess[3]; // powers less 1
      for (int i = 0; i < 3; ++i) excess[i] = expm1_of(alpha * (x[i] - mean));
      const P third = (excess[0] + excess[1] + excess[2]) / 3;
      for (int i = 0; i < 3; ++i) tau[i] += 2 * mu / alpha * (excess[i] - third);
    }
  }
  template<class P>
  SPRINGPROOF_INLINE static void slopes(const P (&x)[3], const P (&)[3], const Parameters<P>& m,
                                        P (&slope)[9], P (&difference)[3]) {
    const P mean = (x[0] + x[1] + x[2]) / 3;
    for (int e = 0; e < 9; ++e) slope[e] = P{};
    for (int p = 0; p < 3; ++p) difference[p] = P{};
    for (int t = 1; t < m.n; t += 2) {
      const P mu = m.value[t], alpha = m.value[t + 1];
      P power[3];
      for (int i = 0; i < 3; ++i) power[i] = exp_of(alpha * (x[i] - mean));
      const P third = (power[0] + power[1] + power[2]) / 3;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          slope[3 * i + j] += 2 * mu * ((i == j ? power[i] : P{}) - (power[i] + power[j] - third) / 3);
      for (int p = 0; p < 3; ++p) {
        const int i = (p + 1) % 3, j = (p + 2) % 3;
        const P centre = alpha * ((x[i] + x[j]) / 2 - mean) - (x[i] + x[j]);
        difference[p] += 2 * mu / alpha * exp_of(centre) * sinh_ratio(alpha / 2, x[i] - x[j]);
      }
    }
  }
  /// sinh(a d)/sinh(d)
  template<class P>
  SPRINGPROOF_INLINE static P sinh_ratio(const P& a, const P& d) {
    const P far = absolute(d) > constant<P>(0.01) ? d : constant<P>(1);
    const P above = exp_of(a * far), below = exp_of(far);
    const P direct = (above - 1 / above) / (below - 1 / below);
    const P square = d * d, excess = a * a - 1;
    const P series = a * (1 + excess * square / 6 * (1 + (3 * a * a - 7) * square / 60));
    return absolute(d) > constant<P>(0.01) ? direct : series;
  }
  template<class P>
  SPRINGPROOF_INLINE static Pressure<P> pressure(const P& dilatation, const Parameters<P>& m) {
    const P j = 1 + dilatation;
    return {m.value[0] / 2 * dilatation * (1 + j) / j, m.value[0] / 2 * (1 + 1 / (j * j))};
  }
  template<class P>
  SPRINGPROOF_INLINE static Pressure<P> dilatation(const P& p, const Parameters<P>& m) {
    const P q = p / m.value[0], length = root(q * q + 1), beyond = q * q / (length + 1);
    const P j = q >= P{} ? q + length : 1 / (length - q);
    return {q >= P{} ? q + beyond : (q - beyond) / (length - q), j / (length * m.value[0])};
  }
};
