#pragma once

#include "mechanics/laws/in_principal_stretches.hpp"
#include "mechanics/laws/log_strain.hpp"
#include "mechanics/laws/ogden.hpp"
#include "mechanics/laws/principal_stress.hpp"
#include "mechanics/laws/saint_venant_kirchhoff.hpp"
#include "mechanics/laws/small_strain.hpp"
#include "mechanics/laws/yeoh.hpp"

#include <Eigen/Core>

/// A law as the element's kernel sees it, at one point. A law is a type with
///   void stress(H, wanted, PointStress&)       without the pressure, where it has one of its own
///   double energy(H)                           N mm/mm³ at rest, without that of the pressure
///   double volume_energy(dilatation)           has_pressure alone: the pressure's integral from 0
///   ValueAndSlope pressure(dilatation)         has_pressure alone: tension-positive mean Cauchy stress, MPa
///   ValueAndSlope dilatation(pressure)         has_pressure alone: its inverse
/// and the constants below; P = stress + p(J - 1) cof F with a pressure, P = stress without. H = grad u is
/// the displacement gradient and F = I + H: a strain made of F - I would lose the digits of small
/// displacements. The isotropic laws are those of mechanics/laws.
namespace springproof::fem_reference {

enum class Wanted { stress, stress_and_tangent };
using ValueAndSlope = mechanics::ValueAndSlope<double>;
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

/// Numbers of a matrix or vector as the plain array that the laws of mechanics take.
template<int n, class Numbers>
auto& array_of(Numbers& numbers) {
  static_assert(Numbers::SizeAtCompileTime == n);
  using Array = std::conditional_t<std::is_const_v<Numbers>, const double, double>[n];
  return *reinterpret_cast<Array*>(numbers.data());
}

/// cof F = dJ/dF
inline Matrix3 cofactor(Kinematics kinematics, const Matrix3& f) {
  if (kinematics == Kinematics::linear) return Matrix3::Identity();
  const Vector9 flat = flatten(f);
  Vector9 result;
  mechanics::cofactor(array_of<9>(flat), array_of<9>(result));
  return result.reshaped<Eigen::RowMajor>(3, 3);
}

/// The dilatation J - 1 of a displacement gradient.
inline double dilatation(Kinematics kinematics, const Matrix3& h) {
  const Vector9 flat = flatten(h);
  return kinematics == Kinematics::linear ? h.trace() : mechanics::growth_of(array_of<9>(flat));
}

/// tangent += factor * d(cof F)/dF
inline void add_cofactor_derivative(Kinematics kinematics, const Matrix3& f, double factor,
                                    Matrix9& tangent) {
  if (kinematics == Kinematics::linear) return;
  const Vector9 flat = flatten(f);
  mechanics::add_cofactor_derivative<mechanics::Full>(array_of<9>(flat), factor, array_of<81>(tangent));
}

/// A law of mechanics/laws with its material.
template<class Law>
class AtPoint {
 public:
  using Material = typename Law::Material;
  using Moduli = typename Law::Moduli;
  static constexpr LawTraits traits{Law::is_finite ? Kinematics::finite : Kinematics::linear,
                                    Moduli::is_symmetric ? TangentSymmetry::symmetric
                                                         : TangentSymmetry::unsymmetric,
                                    Law::has_pressure ? Split::pressure : Split::none};

  explicit AtPoint(const Material& material) : parameters_(mechanics::parameters_of(material)) {}

  double energy(const Matrix3& h) const {
    const Vector9 flat = flatten(h);
    return Law::energy(array_of<9>(flat), parameters_);
  }
  double volume_energy(double dilatation) const { return Law::volume_energy(dilatation, parameters_); }
  void stress(const Matrix3& h, Wanted wanted, PointStress& result) const {
    const Vector9 flat = flatten(h);
    Law::stress(array_of<9>(flat), parameters_, array_of<9>(result.stress));
    if (wanted == Wanted::stress) return;
    double moduli[Moduli::n];
    Law::moduli(array_of<9>(flat), parameters_, moduli);
    for (int r = 0; r < 9; ++r)
      for (int s = 0; s < 9; ++s) result.tangent(r, s) = moduli[Moduli::at(r, s)];
  }
  ValueAndSlope pressure(double dilatation) const { return Law::pressure(dilatation, parameters_); }
  ValueAndSlope dilatation(double p) const { return Law::dilatation(p, parameters_); }

 private:
  mechanics::Parameters<double> parameters_;
};

using SmallStrain = AtPoint<mechanics::SmallStrain>;
using SaintVenantKirchhoff = AtPoint<mechanics::SaintVenantKirchhoff>;
using LogStrain = AtPoint<mechanics::InPrincipalStretches<mechanics::LogStrain>>;
using Ogden = AtPoint<mechanics::InPrincipalStretches<mechanics::Ogden>>;
using Yeoh = AtPoint<mechanics::InPrincipalStretches<mechanics::Yeoh>>;

} // namespace springproof::fem_reference
