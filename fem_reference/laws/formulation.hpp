#pragma once

#include "cases/case/case.hpp"

#include <Eigen/Core>
#include <functional>
#include <optional>

/// What a formulation is to the element loop: a law for the stress at a point and, where the law splits, one
/// for the pressure.
namespace springproof::fem_reference {

using Matrix3 = Eigen::Matrix3d;
/// Row-major flattening of a 3x3: entry 3*i + J.
using Vector9 = Eigen::Matrix<double, 9, 1>;
using Matrix9 = Eigen::Matrix<double, 9, 9, Eigen::RowMajor>;

enum class Wanted { stress, stress_and_tangent };

/// First Piola-Kirchhoff stress P_iJ (MPa) at 3*i + J and, when wanted, A = dP_iJ/dF_kL at (3*i + J, 3*k +
/// L).
struct PointStress {
  Vector9 stress;
  Matrix9 tangent;
};

/// The stress of a deformation gradient with det F > 0, without the part that a VolumetricLaw carries.
using StressLaw =
    std::function<void(const Matrix3& deformation_gradient, Wanted wanted, PointStress& result)>;

/// A function's value and its derivative.
struct ValueAndSlope {
  double value;
  double slope;
};

/// Pressure as tension-positive mean Cauchy stress: p(J), MPa, and its inverse J(p).
struct VolumetricLaw {
  std::function<ValueAndSlope(double volume_ratio)> pressure;
  std::function<ValueAndSlope(double pressure)> volume_ratio;
};

/// Linear: J = 1 + tr(grad u) and areas do not turn. Finite: J = det F.
enum class Kinematics { linear, finite };
enum class TangentSymmetry { symmetric, unsymmetric };

/// P = stress(F) + p(J) cof F when volumetric is set, P = stress(F) otherwise.
struct Formulation {
  StressLaw stress;
  std::optional<VolumetricLaw> volumetric; ///< absent: the law has no split, so only q1 and q2 can carry it
  Kinematics kinematics;
  TangentSymmetry symmetry;
};

/// The formulation a case asks for, with its material.
/// @throws InputError when the material does not belong to it
Formulation make_formulation(const cases::Fem& fem, const cases::Material& material);

/// lambda, mu and kappa of a linear elastic material, MPa.
struct ElasticModuli {
  double lambda, mu, kappa;
};
ElasticModuli elastic_moduli(const cases::LinearElastic& material);

/// One per file of the same name.
Formulation small_strain(const cases::LinearElastic& material);
Formulation saint_venant_kirchhoff(const cases::LinearElastic& material);
Formulation log_strain(const cases::LinearElastic& material);
Formulation ogden(const cases::Ogden& material);

/// Bulk modulus over initial shear modulus of an Ogden material that names none: the volume of the thesis's
/// cube changes by less than 0.1 % under every load, its bar's deflection by 0.02 % from that at twice the
/// ratio.
constexpr double nearly_incompressible_ratio = 1000;

/// The change of volume and area at a point: J, cof F = dJ/dF, and (finite kinematics) d cof F/dF.
double volume_ratio(Kinematics kinematics, const Matrix3& deformation_gradient);
Matrix3 cofactor(Kinematics kinematics, const Matrix3& deformation_gradient);
/// tangent += factor * d(cof F)_iJ/dF_kL = factor * eps_ikm eps_JLN F_mN
void add_cofactor_derivative(Kinematics kinematics, const Matrix3& deformation_gradient, double factor,
                             Matrix9& tangent);

/// Row-major flattening, as in PointStress.
inline Vector9 flatten(const Matrix3& m) {
  Vector9 v;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) v(3 * i + j) = m(i, j);
  return v;
}

} // namespace springproof::fem_reference
