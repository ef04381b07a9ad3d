#pragma once

#include "fem_reference/laws/point.hpp"
#include "mechanics/laws/in_principal_stretches.hpp"
#include "mechanics/laws/log_strain.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace springproof::fem_reference {

using mechanics::divided_difference;

/// The second divided difference of f(x) = ln(x)/2, exact also where the arguments coincide or nearly do.
/// @param x, y, z  > 0
inline double divided_difference(double x, double y, double z) {
  std::array<double, 3> at{x, y, z};
  std::sort(at.begin(), at.end());
  const double middle = (x + y + z) / 3, spread = at[2] - at[0];
  if (spread > 0.02 * middle)
    return (divided_difference(at[2], at[1]) - divided_difference(at[1], at[0])) / spread;
  // Taylor: sum over n of f^(n)(m)/n! times the complete symmetric polynomial of degree n - 2 of the
  // deviations from m; h_n = e1 h_(n-1) - e2 h_(n-2) + e3 h_(n-3), and e1 = 0. Terms above the eighth degree
  // are below 1e-14 of the sum.
  const Eigen::Vector3d d = Eigen::Vector3d(x, y, z) / middle - Eigen::Vector3d::Ones();
  const double e2 = d[0] * d[1] + d[1] * d[2] + d[2] * d[0], e3 = d.prod();
  std::array<double, 9> h{1, 0, -e2};
  for (std::size_t n = 3; n < h.size(); ++n) h[n] = -e2 * h[n - 2] + e3 * h[n - 3];
  double sum = 0;
  for (std::size_t n = 0; n < h.size(); ++n) sum += (n % 2 == 0 ? -1 : 1) * h[n] / (2 * (double(n) + 2));
  return sum / (middle * middle);
}

/// The logarithm of the right stretch, E = ln(U) = ln(C)/2, and its derivatives with respect to C = F^T F in
/// C's principal axes N (columns of `axes`), by divided differences of f = ln/2 at the eigenvalues (Daleckii
/// & Krein 1965; the same derivatives as the projection tensors of Miehe, Apel & Lambrecht 2002, Comput
/// Methods Appl Mech Engrg 191:5383, with one formula for distinct and for equal eigenvalues):
///   dE_ij = f[i,j] dC_ij,    d²E(A, B)_ij = sum_k f[i,k,j] (A_ik B_kj + B_ik A_kj).
struct LogStretch {
  /// @param h  displacement gradient
  explicit LogStretch(const Matrix3& h) {
    const Vector9 flat = flatten(h);
    Vector9 columns;
    mechanics::principal_axes(array_of<9>(flat), array_of<3>(squares), array_of<9>(columns),
                              array_of<3>(strains));
    axes = columns.reshaped<Eigen::RowMajor>(3, 3);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) first(i, j) = divided_difference(squares[i], squares[j]);
  }

  /// Of the stress T that does work on E, in the axes N: d(T : dE/dC_pq)/dC_rs at fixed T, entry
  /// (3*p + q, 3*r + s), symmetric in both pairs.
  Matrix9 curvature(const Matrix3& t) const {
    std::array<std::array<std::array<double, 3>, 3>, 3> second{};
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = i; j < 3; ++j)
        for (std::size_t k = j; k < 3; ++k) {
          const double value = divided_difference(squares[int(i)], squares[int(j)], squares[int(k)]);
          second[i][j][k] = second[i][k][j] = second[j][i][k] = second[j][k][i] = second[k][i][j] =
              second[k][j][i] = value;
        }
    const auto f = [&](int i, int j, int k) {
      return second[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)][static_cast<std::size_t>(k)];
    };
    Matrix9 result = Matrix9::Zero();
    for (int p = 0; p < 3; ++p)
      for (int q = 0; q < 3; ++q)
        for (int b = 0; b < 3; ++b) {
          // Y_pq = sum_b f[b,p,q] A_pb T_bq, half of it for either order of A's indices; and Y_qp
          const double y = f(b, p, q) * t(b, q) / 2, transposed = f(b, q, p) * t(b, p) / 2;
          result(3 * p + q, 3 * p + b) += y;
          result(3 * p + q, 3 * b + p) += y;
          result(3 * p + q, 3 * q + b) += transposed;
          result(3 * p + q, 3 * b + q) += transposed;
        }
    return result;
  }

  Matrix3 axes;
  Eigen::Vector3d squares; ///< eigenvalues of C
  Eigen::Vector3d strains; ///< eigenvalues of E
  Matrix3 first;           ///< f[i,j]
};

} // namespace springproof::fem_reference
