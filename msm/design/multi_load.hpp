#pragma once

#include "cases/case/case.hpp"
#include "mechanics/elastic_moduli.hpp"
#include "msm/lattice.hpp"

#include <optional>

/// Springs fitted to a material's stresses along several homogeneous deformations at once. The multi-load
/// method finds stiffnesses, and a volume term if wanted: the lattice's stress is linear in them at a given
/// deformation, so that the fit is a bounded linear least-squares problem with one minimum. The matched
/// design has the hybrid method's stiffnesses; its exponents come from the material alone. docs/developing/
/// design-theory.md derives them.
namespace springproof::msm {

/// A homogeneous state of the reference material.
struct MaterialState {
  Eigen::Matrix3d deformation_gradient;
  Eigen::Matrix3d cauchy_stress; ///< MPa
};

/// The material on a path at a logarithmic strain (simple shear: the amount of shear). Linear elasticity is s
/// = lambda tr(e) I + 2 mu e with e = ln V; Ogden's is taken as incompressible, its pressure such that the
/// free direction has no stress (simple shear: the direction across the plane of shear).
/// @throws InputError for E <= 0 or nu outside (-1, 0.5)
MaterialState material_state(const cases::Material& material, cases::LoadPath path, double strain);

struct MultiLoadSettings {
  std::vector<cases::LoadPath> paths; ///< at least one
  std::vector<double> weights;        ///< one per path, >= 0, not all 0
  double lowest_strain, highest_strain;
  bool has_volume_term;
  double incompressible_lambda; ///< MPa: Lame's constant that an incompressible material's volume term gives
                                ///< the lattice
  std::optional<double> split = std::nullopt; ///< t = (4K_d/3)/(K_f + 4K_d/3), held; nothing: fitted
  std::optional<Exponents> exponents{};       ///< held exponents of power-log springs; nothing: Hooke's
};

struct MultiLoadFit {
  CellStiffness stiffness;
  double objective; ///< sum of weight * error² over the paths
  /// |s_lattice - s_material| / |s_material| over each path's states; with a volume term and an
  /// incompressible material, of the deviators, for the pressure is then the volume term's.
  std::vector<double> errors;
};

/// Minimises sum of weight * error² over stiffnesses >= 0.
/// @param edge  edge of the cubical cell, mm
/// @throws InputError for settings without a meaning
MultiLoadFit multi_load_method(const cases::Material& material, double edge,
                               const MultiLoadSettings& settings);

/// The same for power-log springs, whose exponents are fitted with the stiffnesses: the squares of
/// exponent_prior (p - exponent) are added to the objective. Where the lattice is then unstable over the
/// strain range (is_stable_over), the exponents go together towards 1/2, with which the tension has no
/// second-order part, as Hooke's, as far as makes it stable; if nothing does, they stay.
/// @param exponent  near which they are held: closed_form_exponent()
/// @throws  as multi_load_method()    @throws SolveError when the minimisation fails
MultiLoadFit multi_load_with_exponents(const cases::Material& material, double edge,
                                       const MultiLoadSettings& settings, double exponent);

/// c of a material's uniaxial test with free sides: nominal stress = E (e + c e² + ...), e = l - 1. With
/// logarithmic strain c = -(1/2 + 2 nu); for Ogden, a = (sum mu_i alpha_i)/(sum mu_i),
///   c = -3/2 + a (1 + nu)²/9 + (1 - 2 nu)²/3.
/// @param poissons_ratio  small-strain ratio, <= 0.5: the material's, or what stands for incompressible
double second_order_coefficient(const cases::Material& material, double poissons_ratio);

/// The one p for all springs with which the hybrid lattice has this c along its axes.
/// @param moduli  lambda and mu of the lattice    @param split  t of hybrid_method()
double closed_form_exponent(double second_order_coefficient, const mechanics::ElasticModuli& moduli,
                            double split);

/// An exponent may leave the closed form by one for an error in the stresses that is smaller by this part.
constexpr double exponent_prior = 0.01;

/// The lowest exponent of springs for an Ogden material. Its nominal stress grows without end, the tension of
/// a spring with p < 0 up to ln q = -1/p alone: with this bound to a stretch of 3.5. Logarithmic strain has
/// a largest nominal stress itself, at a strain of 1/(2 nu), and no bound.
constexpr double lowest_ogden_exponent = -0.8;

struct MatchedFit {
  Exponents exponents;
  double objective; ///< squared relative error of the stresses plus the prior's share
};

/// One exponent for each kind of spring: the least squares of the deviatoric Cauchy stress in uniaxial tests
/// and pure shear along the axes, as parts of the norm of the material's over each path, and of
/// exponent_prior (p - closed form), within the bound.
/// @param material  as for material_state()    @param moduli, split  as for closed_form_exponent()
/// @param strain_range  lowest and highest logarithmic strain of both paths
/// @throws SolveError when the minimisation fails
MatchedFit matched_exponents(const cases::Material& material, const mechanics::ElasticModuli& moduli,
                             double split, const std::array<double, 2>& strain_range);

} // namespace springproof::msm
