// Bodies whose supports move with the load factor.

#include "fem_reference/model.hpp"
#include "tests/fem_reference/scenes.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace springproof;

using cases::Element;
using Eigen::Vector3d;

namespace {

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
    definition.fixed = scenes::on_rollers({"x-", "y-", "z-"});
    cases::Moved down;
    down.region = cases::Region{"z+"};
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

TEST_CASE("a bar whose end is turned by a quarter turn arrives there, and keeps its fourfold symmetry") {
  for (const Element element : {Element::q1_bbar, Element::q2}) {
    cases::Case definition = box(element);
    definition.fixed = {{cases::Region{"z-"}}};
    cases::Moved turn;
    turn.region = cases::Region{"z+"};
    turn.centre = {1, 1, 3};
    turn.angle = 90;
    definition.moved = {turn};
    const cases::Scene scene = cases::make_scene(definition);
    const cases::Solution found = solve(scene);
    CHECK(found.residual <= 1e-9);
    const auto turned = [](const Vector3d& x) { return Vector3d(2 - x.y(), x.x(), x.z()); };
    for (std::size_t n = 0; n < scene.mesh.nodes.size(); ++n) {
      const Vector3d rest = scene.mesh.nodes[n], now = rest + found.displacement[n];
      if (rest.z() == 3) CHECK((now - turned(rest)).norm() < 1e-12); // mm; rounding
      cases::Region other;
      other.near = turned(rest);
      const auto m = static_cast<std::size_t>(cases::select_node(scene.mesh, other));
      CHECK((scene.mesh.nodes[m] + found.displacement[m] - turned(now)).norm() < 1e-8); // mm; residual 1e-10
    }
  }
}

TEST_CASE("a bar follows its end through most of a turn and a whole one, on either backend") {
  for (const double angle : {300., 360.})
    for (const auto backend : {fem_reference::Backend::assembled, fem_reference::Backend::grid}) {
      cases::Case definition = box(Element::q1_bbar);
      definition.body = cases::Box{Vector3d(2, 2, 12), {2, 2, 12}};
      definition.fixed = {{cases::Region{"z-"}}};
      cases::Moved turn;
      turn.region = cases::Region{"z+"};
      turn.centre = {1, 1, 12};
      turn.angle = angle;
      definition.moved = {turn};
      const cases::Scene scene = cases::make_scene(definition);
      const cases::Solution found = fem_reference::Model(scene, MPI_COMM_SELF, backend).solve();
      cases::Region corner;
      corner.near = Vector3d(2, 1, 3); // a quarter of the way up
      const auto node = static_cast<std::size_t>(cases::select_node(scene.mesh, corner));
      const Vector3d arm = scene.mesh.nodes[node] + found.displacement[node] - Vector3d(1, 1, 3);
      INFO(angle << " degrees");
      CHECK(std::atan2(arm.y(), arm.x()) * 180 / std::acos(-1.) ==
            Approx(angle / 4).margin(5)); // the ends warp
      CHECK(found.inverted_cells == 0);
      CHECK(found.load_reached == 1);
    }
}
