#pragma once

#include "mechanics/laws/principal_stress.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>

/// A law as the element's kernel sees it, at one point. A law is a type with
///   void stress(H, wanted, PointStress&)       without the pressure, where it has one of its own
///   double energy(H)                           N mm/mm³ at rest, without that of the pressure
///   double volume_energy(dilatation)           has_pressure alone: the pressure's integral from 0
///   ValueAndSlope pressure(dilatation)         has_pressure alone: tension-positive mean Cauchy stress, MPa
///   ValueAndSlope dilatation(pressure)         has_pressure alone: its inverse
/// and the constants below; P = stress + p(J - 1) cof F with a pressure, P = stress without. H = grad u is
/// the displacement gradient and F = I + H: a strain made of F - I would lose the digits of small
/// displacements.
namespace springproof::fem_reference {

using mechanics::ValueAndSlope;
using mechanics::Wanted;
using Matrix3 = Eigen::Matrix3d;
/// Row-major flattening of a 3x3: entry 3*i + J.
using Vector9 = Eigen::Matrix<double, 9, 1>;
using Matrix9 = Eigen::Matrix<double, 9, 9, Eigen::RowMajor>;

/// First Piola-Kirchhoff stress P_iJ (MPa) at 3*i + J and, when wanted, A = dP_iJ/dF_kL at (3*i + J, 3*k +
/// L).
struct PointStress {
  Vector9 stress;
  Matrix9 tangent;
};

/// Linear: J = 1 + tr H and areas do not turn. Finite: J = det F.
enum class Kinematics { linear, finite };
enum class TangentSymmetry { symmetric, unsymmetric };
/// Without a pressure of its own only q1 and q2 can carry a law.
enum class Split { pressure, none };

struct LawTraits {
  Kinematics kinematics;
  TangentSymmetry symmetry;
  Split split;
};

/// Row-major flattening, as in PointStress.
inline Vector9 flatten(const Matrix3& m) {
  return m.reshaped<Eigen::RowMajor>();
}

/// Cofactors of a matrix, the derivative of its determinant.
inline Matrix3 cofactor(const Matrix3& m) {
  Matrix3 result;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d row = m.row((i + 1) % 3).cross(m.row((i + 2) % 3));
    result.row(i) = row.transpose();
  }
  return result;
}

/// The dilatation J - 1 of a displacement gradient; for finite kinematics the invariants of H, whose sum it
/// is.
inline double dilatation(Kinematics kinematics, const Matrix3& h) {
  if (kinematics == Kinematics::linear) return h.trace();
  return h.trace() + cofactor(h).trace() + h.determinant();
}

/// The right Cauchy-Green tensor less I, twice Green's strain: H + H^T + H^T H.
inline Matrix3 twice_green_strain(const Matrix3& h) {
  return h + h.transpose() + h.transpose() * h;
}

/// cof F = dJ/dF, and (finite kinematics) d cof F/dF.

inline Matrix3 cofactor(Kinematics kinematics, const Matrix3& f) {
  return kinematics == Kinematics::linear ? Matrix3(Matrix3::Identity()) : cofactor(f);
}

/// tangent += factor * d(cof F)_iJ/dF_kL = factor * eps_ikm eps_JLN F_mN
inline void add_cofactor_derivative(Kinematics kinematics, const Matrix3& f, double factor,
                                    Matrix9& tangent) {
  if (kinematics == Kinematics::linear) return;
  for (int i = 0; i < 3; ++i) {
    const int k = (i + 1) % 3, m = (i + 2) % 3; // eps_ikm = 1, eps_imk = -1
    for (int a = 0; a < 3; ++a) {
      const int b = (a + 1) % 3, c = (a + 2) % 3;
      tangent(3 * i + a, 3 * k + b) += factor * f(m, c);
      tangent(3 * i + a, 3 * k + c) -= factor * f(m, b);
      tangent(3 * i + a, 3 * m + b) -= factor * f(k, c);
      tangent(3 * i + a, 3 * m + c) += factor * f(k, b);
    }
  }
}

} // namespace springproof::fem_reference
