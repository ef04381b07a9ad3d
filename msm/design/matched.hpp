#pragma once

#include "cases/case/case.hpp"
#include "mechanics/elastic_moduli.hpp"
#include "msm/lattice.hpp"

/// The matched design: the hybrid method's stiffnesses with power-log springs, whose exponents come from the
/// material alone. docs/designing.md derives them.
namespace springproof::msm {

/// c of a material's uniaxial test with free sides: nominal stress = E (e + c e² + ...), e = l - 1. With
/// logarithmic strain c = -(1/2 + 2 nu); for Ogden, a = (sum mu_i alpha_i)/(sum mu_i),
///   c = -3/2 + a (1 + nu)²/9 + (1 - 2 nu)²/3.
/// @param poissons_ratio  of small strains, at most 0.5: the material's, or what stands for incompressible
double second_order_coefficient(const cases::Material& material, double poissons_ratio);

/// The one p for all springs with which the hybrid lattice has this c along its axes.
/// @param moduli  lambda and mu of the lattice    @param split  t of hybrid_method()
double closed_form_exponent(double second_order_coefficient, const mechanics::ElasticModuli& moduli,
                            double split);

struct MatchedFit {
  Exponents exponents;
  double objective; ///< squared relative error of the stresses plus the prior's share
};

/// An exponent may leave the closed form by one for an error in the stresses that is smaller by this part.
constexpr double exponent_prior = 0.01;

/// The lowest exponent of springs for an Ogden material. Its nominal stress grows without end, the tension of
/// a spring with p < 0 up to ln q = -1/p alone: with this bound to a stretch of 3.5. Logarithmic strain has
/// a largest nominal stress itself, at a strain of 1/(2 nu), and no bound.
constexpr double lowest_ogden_exponent = -0.8;

/// One exponent for each kind of spring: the least squares of the deviatoric Cauchy stress in uniaxial tests
/// and pure shear along the axes, as parts of the norm of the material's over each path, and of
/// exponent_prior (p - closed form), within the bound.
/// @param material  as for material_state()    @param moduli, split  as for closed_form_exponent()
/// @param strain_range  lowest and highest logarithmic strain of both paths
/// @throws SolveError when the minimisation fails
MatchedFit matched_exponents(const cases::Material& material, const mechanics::ElasticModuli& moduli,
                             double split, const std::array<double, 2>& strain_range);

/// Whether the infinite lattice has no unstable wave at either end of the strains, in uniaxial tests along an
/// axis.
bool is_stable_over(const std::array<double, 2>& strain_range, const CellStiffness& stiffness, double edge);

} // namespace springproof::msm
