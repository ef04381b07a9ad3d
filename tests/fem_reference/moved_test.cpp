// Bodies whose supports move with the load factor.

#include "fem_reference/model.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>

using cases::Element;
using Eigen::Vector3d;

namespace {

cases::Region region(const std::string& name) {
  cases::Region result;
  result.name = name;
  return result;
}

cases::Case box(Element element) {
  cases::Case definition;
  definition.body = cases::Box{Vector3d(2, 2, 3), {2, 2, 3}};
  definition.material = cases::LinearElastic{0.3, 0.35};
  definition.fem.formulation = cases::Formulation::log_strain;
  definition.fem.element = element;
  return definition;
}

cases::Solution solve(const cases::Scene& scene) {
  return fem_reference::Model(scene, MPI_COMM_SELF).solve();
}

} // namespace

TEST_CASE("a bar pressed to half its height between sliding plates widens by its law", "[verification]") {
  for (const Element element : {Element::q1_bbar, Element::q2}) {
    cases::Case definition = box(element);
    definition.fixed = {{region("x-"), {true, false, false}},
                        {region("y-"), {false, true, false}},
                        {region("z-"), {false, false, true}}};
    cases::Moved down;
    down.region = region("z+");
    down.components = {false, false, true};
    down.displacement = {0, 0, -1.5};
    definition.moved = {down};
    const cases::Solution found = solve(cases::make_scene(definition));
    // Free sides in logarithmic strains: e_x = -nu e_z.
    const double wide = 2 * std::pow(0.5, -0.35);
    CHECK((Vector3d(2, 2, 3) + found.displacement.back() - Vector3d(wide, wide, 1.5)).norm() <
          1e-8); // mm; residual 1e-10
    CHECK(found.residual <= 1e-9);
    CHECK(found.load_reached == 1);
  }
}

TEST_CASE("a body both of whose ends are turned alike turns as a rigid body, half a turn far") {
  for (const Element element : {Element::q1_bbar, Element::q2}) {
    cases::Case definition = box(element);
    cases::Moved turn;
    turn.axis = Vector3d(1, 2, 2) / 3;
    turn.centre = {1, 0, 2};
    turn.angle = 180;
    for (const char* end : {"z-", "z+"}) {
      turn.region = region(end);
      definition.moved.push_back(turn);
    }
    const cases::Scene scene = cases::make_scene(definition);
    const cases::Solution found = solve(scene);
    const Eigen::Matrix3d rotation = Eigen::AngleAxisd(std::acos(-1.0), turn.axis).toRotationMatrix();
    for (std::size_t n = 0; n < scene.mesh.nodes.size(); ++n) {
      const Vector3d arm = scene.mesh.nodes[n] - turn.centre;
      CHECK((arm + found.displacement[n] - rotation * arm).norm() < 1e-8); // mm
    }
  }
}
