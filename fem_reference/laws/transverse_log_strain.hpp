#pragma once

#include "fem_reference/laws/transverse_small_strain.hpp"

#include <algorithm>
#include <array>

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

  /// Returns d(T : dE/dC_pq)/dC_rs at fixed T as entry (3*p + q, 3*r + s), symmetric in both pairs. T is the
  /// stress that does work on E, in the axes N.
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

/// T = C E with E = ln U and C transversely isotropic about the fibre at rest. T is the stress that does work
/// on E, per deformed volume, and where it has U's axes the Cauchy stress turned back with the body:
///   P = J F S,  S = 2 T : dE/dC.
/// With isotropic constants that is LogStrain, sigma = lambda tr(e) I + 2 mu e. As there the stress depends
/// on F alone but has no energy, and the tangent is slightly unsymmetric; P/J would have the energy E : C :
/// E/2 per rest volume (Miehe, Apel & Lambrecht 2002).
class TransverseLogStrain : public TransverseLaw<mechanics::LogStrain> {
 public:
  static constexpr LawTraits traits{Kinematics::finite, TangentSymmetry::unsymmetric, Split::pressure};
  using TransverseLaw::TransverseLaw;

  /// Work on the straight path of logarithmic strain E s, s from 0 to 1, along which U keeps its axes, as for
  /// LogStrain: the integral of J^s s E : C' : E.
  double energy(const Matrix3& h) const {
    const LogStretch log(h);
    const Vector9 strain = flatten(log.axes * log.strains.asDiagonal() * log.axes.transpose());
    return strain.dot(elasticity_.rest() * strain) * mechanics::ramp_integral(log.strains.sum());
  }
  void stress(const Matrix3& h, Wanted wanted, PointStress& result) const {
    const LogStretch log(h);
    const Matrix3 f = Matrix3::Identity() + h;
    const Matrix3& n = log.axes;
    const Vector9 strain = flatten(n * log.strains.asDiagonal() * n.transpose());
    const Vector9 flat = elasticity_.rest() * strain;
    const Matrix3 t = n.transpose() * flat.reshaped<Eigen::RowMajor>(3, 3) * n; // in the axes N from here
    const Matrix3 second = 2 * log.first.cwiseProduct(t), forward = f * n;
    const double j = f.determinant();
    const Matrix3 first = j * forward * second;
    result.stress = flatten(first * n.transpose());
    if (wanted == Wanted::stress) return;

    Matrix9 turn; // row 3*p + q: N_p x N_q
    for (int p = 0; p < 3; ++p)
      for (int q = 0; q < 3; ++q) turn.row(3 * p + q) = flatten(n.col(p) * n.col(q).transpose()).transpose();
    const Vector9 divided = flatten(log.first);
    const Matrix9 half = turn * elasticity_.rest(); // Eigen holds no product of three without a temporary
    Matrix9 slope = divided.asDiagonal() * (half * turn.transpose()).eval() * divided.asDiagonal();
    slope += log.curvature(t);
    slope *= 4; // dS/dC is twice d(T : dE/dC)/dC, and dC_rs twice the symmetric part of F_kr dF_ks
    const Matrix3 inverse = forward.inverse();
    Matrix9 in_axes;
    for (int i = 0; i < 3; ++i)
      for (int p = 0; p < 3; ++p)
        for (int k = 0; k < 3; ++k)
          for (int r = 0; r < 3; ++r) {
            double sum = i == k ? second(p, r) : 0;
            for (int q = 0; q < 3; ++q)
              for (int s = 0; s < 3; ++s) sum += forward(i, q) * slope(3 * q + p, 3 * s + r) * forward(k, s);
            in_axes(3 * i + p, 3 * k + r) = j * sum + first(i, p) * inverse(r, k);
          }
    for (int i = 0; i < 3; ++i) // dP/dF: the second index of either pair back from the axes N
      for (int k = 0; k < 3; ++k)
        result.tangent.block<3, 3>(3 * i, 3 * k) = n * in_axes.block<3, 3>(3 * i, 3 * k) * n.transpose();
  }
};

} // namespace springproof::fem_reference
