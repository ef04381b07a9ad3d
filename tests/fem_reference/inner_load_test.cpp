// Loads on faces inside a body, between its cells. Looked at for the same, a load that is printed and not
// applied: springs and measures (cases/scene/loads.cpp takes each face of a selection once), the grid's
// quadratic loads, refined meshes, point forces on nodes of quadratic elements, and boxes whose faces come
// from the cells of both sides.

#include "cases/case/error.hpp"
#include "cases/scene/loads.hpp"
#include "fem_reference/model.hpp"
#include "scenes.hpp"
#include "tests/support/scene_in_tetrahedra.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace springproof;

using Eigen::Vector3d;
using fem_reference::Backend;

namespace {

cases::Region plane_at(double x) {
  cases::Region plane;
  plane.name = "plane";
  plane.part = cases::Part{{}, Vector3d(x, -1, -1), Vector3d(x, 3, 3)};
  return plane;
}

const cases::loads::Traction pull{{0.0003, 0, 0}};
const cases::loads::Torque inner_torque{1e-4, Vector3d::UnitX(), {4, 1, 1}};

/// A bar of 8 x 2 x 2 mm, held at x = 0, nu = 0, under a load on its cross section at x = 4.
cases::Case bar(cases::Element element, int refine, const cases::loads::Kind& kind) {
  cases::Case definition;
  definition.body = cases::Box{{8, 2, 2}, {4, 2, 2}};
  definition.material = cases::LinearElastic{0.3, 0};
  definition.fem.formulation = cases::Formulation::small_strain;
  definition.fem.element = element;
  definition.fem.refine = refine;
  definition.fixed = {{{"x-"}}};
  definition.loads = {{plane_at(4), kind}};
  return definition;
}

Vector3d displacement_at(const cases::Scene& scene, const cases::Solution& solution, const Vector3d& place) {
  cases::Region node;
  node.near = place;
  return solution.displacement[static_cast<std::size_t>(cases::select_node(scene.mesh, node))];
}

} // namespace

TEST_CASE("a traction on a cross section inside a bar pulls what lies between it and the support",
          "[verification]") {
  for (const cases::Element element : scenes::all_elements)
    for (const int refine : {0, 1})
      for (const Backend backend : {Backend::assembled, Backend::automatic}) {
        const auto scene = tetrahedra::make_scene(bar(element, refine, pull));
        CHECK(cases::area(scene.mesh, scene.loads.front().selection) == Approx(4)); // each face once
        const auto found = fem_reference::Model(scene, MPI_COMM_SELF, backend).solve();
        CAPTURE(cases::name_of(element), refine, static_cast<int>(backend));
        // t x/E, exact for each element but one: rounding and the solvers' 1e-9. The pressure jumps at x = 4,
        // and a continuous one errs by a part of the cells beside it, which refinement takes away.
        const double part = element == cases::Element::p2_p1 ? (refine == 0 ? 0.1 : 0.01) : 1e-8;
        CHECK(displacement_at(scene, found, {8, 0, 2}).x() == Approx(0.004).epsilon(part));
        CHECK(displacement_at(scene, found, {2, 2, 0}).x() == Approx(0.002).epsilon(part));
      }
}

TEST_CASE("a torque on a cross section inside a bar twists what lies beyond as a body", "[verification]") {
  for (const cases::Element element : scenes::all_elements)
    for (const Backend backend : {Backend::assembled, Backend::automatic}) {
      const auto scene = tetrahedra::make_scene(bar(element, 0, inner_torque));
      const auto found = fem_reference::Model(scene, MPI_COMM_SELF, backend).solve();
      const double inner = displacement_at(scene, found, {6, 0, 0}).z(),
                   end = displacement_at(scene, found, {8, 0, 0}).z();
      CAPTURE(cases::name_of(element), static_cast<int>(backend), inner, end);
      CHECK(std::abs(end) > 1e-4);
      CHECK(end == Approx(inner).epsilon(0.2)); // no moment beyond x = 4 mm; warping decays within a cell
    }
}

TEST_CASE("a load on what is no face of the elements is no answer") {
  cases::Scene scene = cases::make_scene(bar(cases::Element::q1, 0, pull));
  scene.loads.front().selection.faces.front() = {0, 1, 21, 20}; // a face across a cell
  CHECK_THROWS_AS(fem_reference::Model(scene, MPI_COMM_WORLD, Backend::assembled), cases::SolveError);
}
