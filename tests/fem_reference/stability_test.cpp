#include "fem_reference/model.hpp"

#include "scenes.hpp"
#include "tests/support/scene_in_tetrahedra.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace springproof;

using Eigen::Vector3d;

namespace {

/// A column of 1 x 1 x 10 mm, clamped below and pressed on top with a fraction of its Euler load pi² E I/(4
/// L²).
cases::Solution pressed_column(double fraction, cases::Formulation formulation, cases::Element element,
                               const cases::Material& material = cases::LinearElastic{1, 0}) {
  const double euler = std::acos(-1.) * std::acos(-1.) / 12 / 400; // N, at E = 1 MPa
  cases::Case definition;
  definition.body = cases::Box{Vector3d(1, 1, 10), {1, 1, 10}};
  definition.material = material;
  definition.fem.formulation = formulation;
  definition.fem.element = element;
  definition.fixed.push_back({{"z-"}});
  definition.loads = {scenes::traction("z+", {0, 0, -fraction * euler})};
  return fem_reference::Model(tetrahedra::make_scene(definition), MPI_COMM_SELF).solve();
}

} // namespace

TEST_CASE("a straight column is stable below its Euler load and unstable in both bending directions above",
          "[verification]") {
  for (const auto formulation :
       {cases::Formulation::saint_venant_kirchhoff, cases::Formulation::log_strain}) {
    const auto element = cases::Element::q2;
    CAPTURE(cases::name_of(formulation));
    CHECK(pressed_column(0.95, formulation, element).negative_eigenvalues ==
          0); // 5 %: shear, shortening and mesh take 2 %
    CHECK(pressed_column(1.05, formulation, element).negative_eigenvalues == 2);
    CHECK(pressed_column(8, formulation, element).negative_eigenvalues ==
          2); // the second mode comes at 9 Euler loads
  }
}

TEST_CASE("pressures of nodes do not count as instabilities", "[verification]") {
  const struct {
    cases::Formulation formulation;
    cases::Material material;
  } rows[] = {{cases::Formulation::log_strain, cases::LinearElastic{1, 0}},
              {cases::Formulation::hyperelastic, cases::Ogden{{0.35}, {2}, 7. / 3}}}; // E = 1 MPa, symmetric
  for (const auto& [formulation, material] : rows) {
    CAPTURE(cases::name_of(formulation));
    const auto element = cases::Element::p2_p1;
    CHECK(pressed_column(0.9, formulation, element, material).negative_eigenvalues == 0);
    CHECK(pressed_column(1.1, formulation, element, material).negative_eigenvalues == 2);
  }
}
