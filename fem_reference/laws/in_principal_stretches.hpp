#pragma once

#include "fem_reference/laws/point.hpp"

namespace springproof::fem_reference {

/// An isotropic law given in principal axes. With F = sum lambda_i n_i x N_i and P_i = tau_i/lambda_i the
/// only entries of A = dP/dF in the axes n, N are
///   A_iijj = dP_i/d lambda_j,   A_ijij = m_ij,   A_ijji = (lambda_j² m_ij - tau_j)/(lambda_i lambda_j),
/// m_ij = (tau_i - tau_j)/(lambda_i² - lambda_j²) (i != j), which stay exact when stretches coincide as long
/// as m_ij does.
/// @tparam Principal  a law of mechanics/laws
template<class Principal>
class InPrincipalStretches : public Principal {
 public:
  static constexpr LawTraits traits{
      Kinematics::finite, Principal::has_energy ? TangentSymmetry::symmetric : TangentSymmetry::unsymmetric,
      Split::pressure};

  using Principal::Principal;

  double energy(const Matrix3& h) const {
    const Eigen::SelfAdjointEigenSolver<Matrix3> right(twice_green_strain(h), Eigen::EigenvaluesOnly);
    return Principal::energy(log_stretches(right.eigenvalues()));
  }

  void stress(const Matrix3& h, Wanted wanted, PointStress& result) const {
    // eigenvectors of C - I are orthonormal to rounding error even when eigenvalues (nearly) coincide
    const Eigen::SelfAdjointEigenSolver<Matrix3> right(twice_green_strain(h));
    const Matrix3& material = right.eigenvectors(); // its columns are the axes N, those of spatial n
    const Eigen::Vector3d stretches = (1 + right.eigenvalues().array()).sqrt();
    const Matrix3 spatial = (material + h * material) * stretches.cwiseInverse().asDiagonal();
    const mechanics::PrincipalStress principal =
        Principal::stress(log_stretches(right.eigenvalues()), wanted);
    const Eigen::Vector3d first = principal.kirchhoff.cwiseQuotient(stretches);
    result.stress = flatten(spatial * first.asDiagonal() * material.transpose());
    if (wanted == Wanted::stress) return;
    Matrix9 axes; // column 3*i + j is n_i x N_j
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b)
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j) axes(3 * a + b, 3 * i + j) = spatial(a, i) * material(b, j);
    const Matrix9 half = axes * tangent_in_axes(principal, stretches);
    result.tangent.noalias() = half * axes.transpose();
  }

 private:
  /// @param excess  eigenvalues of C - I
  static Eigen::Vector3d log_stretches(const Eigen::Vector3d& excess) {
    return excess.unaryExpr([](double e) { return 0.5 * std::log1p(e); });
  }

  /// Row and column 3*i + j belong to n_i x N_j.
  static Matrix9 tangent_in_axes(const mechanics::PrincipalStress& s, const Eigen::Vector3d& stretches) {
    Matrix9 tangent = Matrix9::Zero();
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        tangent(4 * i, 4 * j) =
            (s.slope(i, j) - (i == j ? s.kirchhoff(i) : 0)) / (stretches(i) * stretches(j));
    for (int p = 0; p < 3; ++p) {
      const int i = (p + 1) % 3, j = (p + 2) % 3;
      const double m = s.difference(p);
      const double crossed =
          (stretches(j) * stretches(j) * m - s.kirchhoff(j)) / (stretches(i) * stretches(j));
      tangent(3 * i + j, 3 * i + j) = tangent(3 * j + i, 3 * j + i) = m;
      tangent(3 * i + j, 3 * j + i) = tangent(3 * j + i, 3 * i + j) = crossed;
    }
    return tangent;
  }
};

} // namespace springproof::fem_reference
