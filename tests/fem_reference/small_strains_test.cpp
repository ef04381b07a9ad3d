// Strains that rounding of positions would hide: a state is kept as displacements, and every law takes their
// gradient. Looked at for the same: springs (tests/msm/small_strains_test.cpp), the pressures of averaged
// elements (J - 1, not J), volume terms, energies, logarithms of stretches, and steps in time.

#include "fem_reference/model.hpp"
#include "scenes.hpp"
#include "tests/support/largest.hpp"
#include "tests/support/scene_in_tetrahedra.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace springproof;

using cases::Element;
using Eigen::Vector3d;
using fem_reference::Backend;

namespace {

/// A cube of 10 mm and 6 x 6 x 6 cells pulled along z by a traction, free to contract.
cases::Scene pulled_cube(cases::Formulation formulation, Element element, double traction) {
  cases::Case definition;
  definition.body = cases::Box{{10, 10, 10}, {6, 6, 6}};
  definition.material = cases::LinearElastic{0.3, 0.35};
  definition.fem.formulation = formulation;
  definition.fem.element = element;
  definition.fixed = scenes::on_rollers({"x-", "y-", "z-"});
  definition.loads = {scenes::traction("z+", {0, 0, traction})};
  return tetrahedra::make_scene(definition);
}

/// Largest distance from u = strain (z e_z - nu (x e_x + y e_y)), over the largest displacement.
double error_of(const cases::Scene& scene, const cases::Solution& solution, double along, double across) {
  double off = 0;
  for (std::size_t n = 0; n < solution.displacement.size(); ++n) {
    const Vector3d at = scene.mesh.nodes[n], exact(across * at.x(), across * at.y(), along * at.z());
    off = larger(off, (solution.displacement[n] - exact).norm());
  }
  return off / (10 * std::abs(along));
}

} // namespace

TEST_CASE(
    "a pulled cube of small strain is exact at strains from 1e-12 to 1e-3, in one iteration where assembled",
    "[verification][long]") {
  for (const double strain : {1e-12, 1e-9, 3e-6, 1e-5, 1e-3})
    for (const Element element : scenes::all_elements)
      for (const Backend backend : {Backend::assembled, Backend::automatic}) {
        const cases::Scene scene = pulled_cube(cases::Formulation::small_strain, element, 0.3 * strain);
        const cases::Solution found = fem_reference::Model(scene, MPI_COMM_SELF, backend).solve();
        CAPTURE(strain, cases::name_of(element), static_cast<int>(backend), found.newton_iterations);
        CHECK(error_of(scene, found, strain, -0.35 * strain) <= 1e-9); // the solvers' tolerance
        if (backend == Backend::assembled) CHECK(found.newton_iterations == 1);
      }
}

TEST_CASE("a pulled cube of logarithmic strain is exact at strains from 1e-12 to 1e-3",
          "[verification][long]") {
  for (const double strain : {1e-12, 1e-9, 1e-5, 1e-3})
    for (const Element element : scenes::all_elements)
      for (const Backend backend : {Backend::assembled, Backend::automatic}) {
        // Cauchy stress E e on an area that contracts by exp(-2 nu e)
        const double traction = 0.3 * strain * std::exp(-0.7 * strain);
        const cases::Scene scene = pulled_cube(cases::Formulation::log_strain, element, traction);
        const cases::Solution found = fem_reference::Model(scene, MPI_COMM_SELF, backend).solve();
        CAPTURE(strain, cases::name_of(element), static_cast<int>(backend), found.newton_iterations);
        CHECK(error_of(scene, found, std::expm1(strain), std::expm1(-0.35 * strain)) <= 1e-9);
      }
}
