#pragma once

#include "cases/case/case.hpp"
#include "mechanics/elastic_moduli.hpp"
#include "msm/lattice.hpp"

/// What the exponents of power-log springs follow from, and what holds fitted ones.
/// docs/developing/design-theory.md derives the closed form.
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

/// An exponent may leave the closed form by one for an error in the stresses that is smaller by this part.
constexpr double exponent_prior = 0.01;

/// The lowest exponent of springs for an Ogden material. Its nominal stress grows without end, the tension of
/// a spring with p < 0 up to ln q = -1/p alone: with this bound to a stretch of 3.5. Logarithmic strain has
/// a largest nominal stress itself, at a strain of 1/(2 nu), and no bound.
constexpr double lowest_ogden_exponent = -0.8;

} // namespace springproof::msm
