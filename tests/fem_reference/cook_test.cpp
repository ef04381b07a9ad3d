#include "fem_reference/model.hpp"

#include "scenes.hpp"
#include "tests/support/scene_in_tetrahedra.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

using namespace springproof;

using cases::Element;
using Eigen::Vector3d;

namespace {

/// Cook's membrane of n x n x 1 cells: corners (0,0), (48,44), (48,60), (0,44) mm, 1 mm thick and in plane
/// strain, x = 0 clamped, a dead traction of 1/16 MPa in +y on x = 48.
cases::Scene membrane(int n, double bulk_modulus, Element element) {
  cases::Scene scene;
  scene.definition.material = cases::Ogden{{0.4225}, {2}, bulk_modulus}; // neo-Hooke
  scene.definition.fem.formulation = cases::Formulation::hyperelastic;
  scene.definition.fem.element = element;
  scene.mesh = cases::make_box_mesh(Vector3d::Ones(), {n, n, 1});
  scene.mesh.grid.reset();
  if (cases::facts_of(element).is_tetrahedron) scene.mesh = bodies::cut_in_tetrahedra(scene.mesh);
  for (Vector3d& x : scene.mesh.nodes.stored()) { // bilinear in the unit square
    const double s = x.x(), t = x.y();
    x = {48 * s, 44 * s * (1 - t) + 44 * t * (1 - s) + 60 * s * t, x.z()};
  }
  const auto faces_where = [&](const auto& holds) {
    cases::Selection selection;
    for (std::size_t k = 0; k < scene.mesh.nodes.size(); ++k)
      if (holds(scene.mesh.nodes[k])) selection.nodes.push_back(static_cast<int>(k));
    for (const auto& face : cases::boundary_faces(scene.mesh))
      if (std::all_of(face.begin(), face.end(),
                      [&](int k) { return holds(scene.mesh.nodes[static_cast<std::size_t>(k)]); }))
        selection.faces.push_back(face);
    return selection;
  };
  scene.constrained.push_back(
      {faces_where([](const Vector3d& x) { return x.x() < 1e-9; }), {true, true, true}});
  scene.constrained.push_back(
      {faces_where([](const Vector3d& x) { return x.z() < 1e-9; }), {false, false, true}});
  scene.constrained.push_back(
      {faces_where([](const Vector3d& x) { return x.z() > 1 - 1e-9; }), {false, false, true}});
  cases::Load load{{}, cases::loads::Traction{{0, 1. / 16, 0}}};
  scene.loads.push_back({faces_where([](const Vector3d& x) { return x.x() > 48 - 1e-9; }), load});
  return scene;
}

/// u_y at (48, 52), mm.
double tip_deflection(int n, double bulk_modulus, Element element) {
  const auto scene = membrane(n, bulk_modulus, element);
  const auto solution = fem_reference::Model(scene, MPI_COMM_SELF).solve();
  cases::Region tip;
  tip.near = Vector3d(48, 52, 0);
  return solution.displacement[static_cast<std::size_t>(cases::select_node(scene.mesh, tip))].y();
}

/// @param n  cells along an edge of the first mesh; each further mesh has twice as many
/// @param printed  mm     @param digit  unit of the last digit printed, mm
void deflects(Element element, int n, const std::vector<double>& printed, double digit) {
  for (std::size_t i = 0; i < printed.size(); ++i, n *= 2) {
    const double computed = tip_deflection(n, 0.91542, element);
    CAPTURE(n, computed, printed[i]);
    CHECK(std::abs(computed - printed[i]) <= 0.5 * digit); // rounding of the print
  }
}

} // namespace

TEST_CASE("Cook's membrane of q1 cells deflects as the deal.II code gallery prints it",
          "[verification][long]") {
  deflects(Element::q1, 2, {8.638}, 0.001);
  deflects(Element::q1, 4, {12.07, 13.86, 14.49, 14.67, 14.72}, 0.01);
}

TEST_CASE("Cook's membrane of q2 cells deflects as the deal.II code gallery prints it",
          "[verification][long]") {
  deflects(Element::q2, 2, {14.30, 14.65, 14.71, 14.73, 14.74}, 0.01);
}

TEST_CASE("Cook's membrane of 64 x 64 q2 cells deflects as the deal.II code gallery prints it",
          "[verification][release]") {
  deflects(Element::q2, 64, {14.74}, 0.01);
}

TEST_CASE("Cook's membrane of tetrahedra deflects to the limit of the deal.II code gallery's hexahedra",
          "[verification][long]") {
  deflects(Element::p2, 32, {14.74}, 0.02);
  const double coarse = tip_deflection(16, 0.91542, Element::p1),
               fine = tip_deflection(32, 0.91542, Element::p1);
  CAPTURE(coarse, fine);
  CHECK(std::abs(fine - 14.74) < std::abs(coarse - 14.74) / 2); // order 2, less at the clamped corner
}

TEST_CASE("the nearly incompressible membrane locks with q1 and p1, and with no element that has a pressure "
          "of its own",
          "[verification]") {
  const double bulk_modulus = 0.4225 * 5000; // nu = 0.4999
  const double converged = tip_deflection(16, bulk_modulus, Element::q2_p1);
  const struct {
    Element element;
    double least, most; // relative to the converged deflection
  } rows[] = {{Element::q1, 0.0, 0.6},      {Element::q1_bbar, 0.95, 1.02}, {Element::q1_p0, 0.95, 1.02},
              {Element::q2_p1, 0.97, 1.02}, {Element::p1, 0.0, 0.6},        {Element::p2_p0, 0.95, 1.02},
              {Element::p2_p1, 0.95, 1.02}};
  for (const auto& row : rows) {
    const double computed = tip_deflection(8, bulk_modulus, row.element) / converged;
    CAPTURE(cases::name_of(row.element), computed, converged);
    CHECK(computed >= row.least);
    CHECK(computed <=
          row.most); // a mesh of 8 cells: what its discretisation error leaves open, locking takes half
  }
}
