#include "fem_reference/model.hpp"

#include "scenes.hpp"
#include "tests/support/largest.hpp"

#include <catch2/catch.hpp>

using namespace springproof;

using cases::Element;
using scenes::LoadSet;
using scenes::Test;

namespace {

fem_reference::Model model_of(cases::Formulation formulation, Element element) {
  return fem_reference::Model(
      cases::make_scene(
          scenes::cube(Test::shear, LoadSet::large, scenes::thesis_elastic(), formulation, element, 2)),
      MPI_COMM_SELF);
}

} // namespace

TEST_CASE("a re-solve after less load finds the equilibrium that a solve from rest finds", "[verification]") {
  const auto formulation = GENERATE(cases::Formulation::small_strain, cases::Formulation::log_strain);
  const auto element = GENERATE(Element::q1, Element::q1_bbar, Element::q2);
  auto model = model_of(formulation, element);
  const cases::Solution first = model.solve();
  const cases::Solution less = model.solve_again(0.9);
  const cases::Solution again = model.solve_again(1);
  CHECK(less.load_reached == 0.9);
  CHECK(largest_difference(first, less) > 0.01);  // mm, of displacements of some millimetres
  CHECK(largest_difference(first, again) < 1e-7); // mm: what a residual of 1e-10 leaves undecided
  CHECK(again.residual <= 1e-10);                 // the bound that is asked for
}

TEST_CASE("a linear body's re-solve needs no factorisation, a nonlinear one's does") {
  for (const Element element : {Element::q1, Element::q1_bbar, Element::q2}) {
    auto linear = model_of(cases::Formulation::small_strain, element);
    CHECK(linear.solve().factorisations == 1);
    CHECK(linear.solve_again(0.9).factorisations == 0);
    auto nonlinear = model_of(cases::Formulation::log_strain, element);
    CHECK(nonlinear.solve().factorisations > 1);
    CHECK(nonlinear.solve_again(0.9).factorisations > 0);
  }
}

TEST_CASE("a looser tolerance is met with no more iterations") {
  auto model = model_of(cases::Formulation::log_strain, Element::q1);
  mechanics::EquilibriumSettings settings = fem_reference::default_settings();
  const cases::Solution tight = model.solve(settings);
  settings.tolerance = 1e-2;
  const cases::Solution loose = model.solve(settings);
  CHECK(loose.residual <= 1e-2);
  CHECK(loose.newton_iterations < tight.newton_iterations);
}
