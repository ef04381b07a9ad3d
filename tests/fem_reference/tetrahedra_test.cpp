#include "tests/support/scene_in_tetrahedra.hpp"

#include "cases/case/elements.hpp"
#include "fem_reference/assembled_body.hpp"
#include "fem_reference/inertia.hpp"
#include "fem_reference/model.hpp"
#include "mechanics/petsc/spectrum.hpp"
#include "scenes.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace springproof;

using cases::Element;
using Eigen::Vector3d;

namespace {

/// A body whose corner is watched, before its cells are made.
struct Body {
  const char* name;
  cases::Case definition;
  Vector3d watched; ///< mm
};

cases::Case block(const Vector3d& size, const std::array<int, 3>& cells, std::vector<cases::Load> loads) {
  cases::Case definition;
  definition.body = cases::Box{size, cells};
  definition.material = cases::LinearElastic{0.3, 0.35};
  definition.material_dynamics = {1000., 0, 0};
  definition.fem.formulation = cases::Formulation::log_strain;
  definition.fixed = {{{"z-"}}};
  definition.loads = std::move(loads);
  return definition;
}

std::vector<Body> bodies_of_both_shapes() {
  const cases::Load torque{{"z+"}, cases::loads::Torque{0.6, Vector3d::UnitZ(), {5, 5, 20}}};
  Body pressed{"pressed plate", block({40, 40, 10}, {4, 4, 1}, {}), {40, 40, 10}};
  pressed.definition.loads = {scenes::traction("z+", {0, 0, -0.03})};
  const cases::Load weight{{}, cases::loads::Gravity{{0, 0, -9.81}}};
  return {
      {"sheared cube", block({10, 10, 10}, {2, 2, 2}, {scenes::traction("z+", {0.01, 0, 0})}), {10, 10, 10}},
      {"cantilever", block({10, 10, 40}, {2, 2, 8}, {scenes::traction("z+", {0.0005, 0, 0})}), {10, 10, 40}},
      {"twisted bar", block({10, 10, 20}, {2, 2, 4}, {torque}), {10, 10, 20}},
      {"heavy block", block({20, 20, 20}, {2, 2, 2}, {weight}), {20, 20, 20}},
      pressed};
}

struct LimitAndBar {
  Vector3d limit; ///< mm
  double bar;     ///< the change that the last refinement made, mm
};

/// The displacement of the watched corner on a mesh that is halved twice.
LimitAndBar limit_of(Body body, Element element) {
  std::vector<Vector3d> values;
  body.definition.fem.element = element;
  for (int refine = 0; refine < 3; ++refine) {
    body.definition.fem.refine = refine;
    const cases::Scene scene = tetrahedra::make_scene(body.definition);
    cases::Region corner;
    corner.near = body.watched;
    const auto node = static_cast<std::size_t>(cases::select_node(scene.mesh, corner));
    values.push_back(fem_reference::Model(scene, MPI_COMM_SELF).solve().displacement[node]);
  }
  return {values[2], (values[2] - values[1]).norm()};
}

/// Hexahedra and tetrahedra of three kinds have one limit within their bars.
void check_one_limit(const Body& body) {
  const LimitAndBar hexahedra = limit_of(body, Element::q2), tetrahedra = limit_of(body, Element::p2),
                    with_pressure = limit_of(body, Element::p2_p0),
                    taylor_hood = limit_of(body, Element::p2_p1);
  CAPTURE(body.name, hexahedra.limit.transpose(), hexahedra.bar, tetrahedra.limit.transpose(), tetrahedra.bar,
          with_pressure.limit.transpose(), with_pressure.bar, taylor_hood.limit.transpose(), taylor_hood.bar);
  CHECK((hexahedra.limit - tetrahedra.limit).norm() <= hexahedra.bar + tetrahedra.bar);
  CHECK((hexahedra.limit - with_pressure.limit).norm() <= hexahedra.bar + with_pressure.bar);
  CHECK((hexahedra.limit - taylor_hood.limit).norm() <= hexahedra.bar + taylor_hood.bar);
  CHECK((with_pressure.limit - taylor_hood.limit).norm() <= with_pressure.bar + taylor_hood.bar);
  CHECK(tetrahedra.bar <= 0.05 * tetrahedra.limit.norm()); // else the check would say little
}

/// Smallest eigenvalues of the vibrations, 1/s².
Eigen::ArrayXd squared_frequencies(const cases::Case& definition) {
  const auto body = fem_reference::vibrating_body(tetrahedra::make_scene(definition));
  return mechanics::petsc::lowest_vibrations(body.stiffness, body.mass, 5).values;
}

} // namespace

TEST_CASE("five bodies of hexahedra and of tetrahedra have one limit each, within the bars of both",
          "[verification][release]") {
  const std::vector<Body> bodies = bodies_of_both_shapes();
  REQUIRE(bodies.size() == 5);
  for (const Body& body : bodies) check_one_limit(body);
}

TEST_CASE("lumped masses of tetrahedra are positive and add up to the body's", "[verification]") {
  for (const Element element : {Element::p1, Element::p2, Element::p2_p0, Element::p2_p1}) {
    cases::Case definition = block({10, 10, 20}, {1, 1, 2}, {});
    definition.fem.element = element;
    definition.fem.mass = cases::ElementMass::lumped;
    const cases::Scene scene = tetrahedra::make_scene(definition);
    const fem_reference::AssembledBody body(scene, MPI_COMM_SELF);
    const auto mass = make_inertia(scene, body.discretisation, body.formulations).mass;
    CAPTURE(cases::name_of(element));
    CHECK(mass.nonZeros() == mass.rows());
    CHECK(mass.diagonal().minCoeff() > 0);
    CHECK(mass.sum() == Approx(3 * 1e-9 * 2000).epsilon(1e-13)); // t
  }
}

TEST_CASE("dampers of cells refuse a pressure of the whole body, and say what to take instead") {
  cases::Case definition = block({10, 10, 10}, {1, 1, 1}, {});
  definition.fem.element = Element::p2_p1;
  cases::settle_element(definition, true);
  definition.material_dynamics.stiffness_damping = 0.01;
  CHECK_THROWS_WITH(cases::settle_element(definition, true), Catch::Contains("must be \"p2_p0\""));
}

TEST_CASE("the frequencies of a clamped block of tetrahedra tend to those of hexahedra", "[verification]") {
  cases::Case definition = block({10, 10, 20}, {1, 1, 2}, {});
  definition.fem.formulation = cases::Formulation::small_strain;
  const auto found = [&](Element element, int refine, cases::ElementMass mass) {
    definition.fem.element = element;
    definition.fem.refine = refine;
    definition.fem.mass = mass;
    return squared_frequencies(definition);
  };
  const Eigen::ArrayXd limit = found(Element::q2, 2, cases::ElementMass::consistent);
  for (const Element element : {Element::p2, Element::p2_p1})
    for (const auto mass : {cases::ElementMass::consistent, cases::ElementMass::lumped}) {
      std::vector<double> worst;
      for (int refine = 0; refine < 3; ++refine)
        worst.push_back((found(element, refine, mass) / limit - 1).abs().maxCoeff());
      CAPTURE(cases::name_of(element), cases::name_of(mass), limit.transpose(), worst);
      // clamped edges keep the order below 2, that of lumped masses: halvings divide by 3 about
      CHECK(worst[1] <= worst[0] / 2.5);
      CHECK(worst[2] <= worst[1] / 2.5);
    }
}
