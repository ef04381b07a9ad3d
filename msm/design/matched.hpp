#pragma once

#include "msm/design/exponents.hpp"

/// The matched design: the hybrid method's stiffnesses with power-log springs, whose exponents come from the
/// material alone. docs/developing/design-theory.md derives them.
namespace springproof::msm {

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
