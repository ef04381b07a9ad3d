#include "fem_reference/cuboid.hpp"
#include "fem_reference/element_fields.hpp"
#include "fem_reference/model.hpp"
#include "mechanics/shape_products.hpp"
#include "tests/fem_reference/scenes.hpp"
#include "tests/support/bodies.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <numeric>

using namespace springproof;

using cases::Element;
using Eigen::Vector3d;
using fem_reference::Backend;
using fem_reference::Model;

// Other places checked for this defect: the springs' volumes (msm::measure_cells() takes the deformed nodes),
// CalculiX's and other programs' results (the same now, calculix_test.cpp), the volume over time (the same
// functions as at the end), stress and strain of cells (their means over the rest or deformed cell, as
// documented), landmarks and surfaces (carried by the body's own cells in both models, as documented).

namespace {

/// A bar in uniform tension along x, whose displacement every element has exactly, at an extreme load.
cases::Case pulled(Element element, int refine) {
  cases::Case bar = bodies::clamped_box({3, 2, 2}, {});
  bar.material = cases::LinearElastic{0.1, 0.2};
  bar.fixed = scenes::on_rollers({"x-", "y-", "z-"});
  bar.loads = {scenes::traction("x+", {0.05, 0, 0})};
  bar.fem.formulation = cases::Formulation::small_strain;
  bar.fem.element = element;
  bar.fem.refine = refine;
  return bar;
}

/// A clamped block that is bent and sheared.
cases::Case bent(Element element, int refine = 0) {
  cases::Case block = bodies::clamped_box({4, 2, 3}, {});
  block.loads = {scenes::traction("z+", {0.01, 0.004, 0})};
  block.fem.formulation = cases::Formulation::small_strain;
  block.fem.element = element;
  block.fem.refine = refine;
  block.measures = {{"", cases::measures::DisplacementFieldL2{}}};
  return block;
}

cases::Solution solved(const cases::Case& definition, Backend backend) {
  return Model(cases::make_scene(definition), MPI_COMM_SELF, backend).solve();
}

double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.);
}

} // namespace

TEST_CASE("the volume of small strains is that of the deformed body, at an extreme load too",
          "[verification]") {
  const double along = 1 + 0.05 / 0.1, across = 1 - 0.2 * 0.05 / 0.1;
  for (const auto backend : {Backend::assembled, Backend::grid})
    for (const Element element : {Element::q1, Element::q1_bbar, Element::q2, Element::q2_p1})
      for (const int refine : {0, 1}) {
        if (backend == Backend::grid && element == Element::q2_p1) continue; // not there
        CAPTURE(int(backend), cases::name_of(element), refine);
        const cases::Solution solution = solved(pulled(element, refine), backend);
        // 12 (1 + div u) would be 15.6; the solver's 1e-9
        CHECK(sum(solution.cell_volume) == Approx(12 * along * across * across).epsilon(1e-8));
      }
}

TEST_CASE("the volume of bent trilinear cells is that between their nodes, of both backends",
          "[verification]") {
  for (const auto backend : {Backend::assembled, Backend::grid}) {
    cases::Case block = bent(Element::q1);
    block.loads[0].scale(10);
    const cases::Scene scene = cases::make_scene(block);
    const cases::Solution solution = Model(scene, MPI_COMM_SELF, backend).solve();
    for (std::size_t c = 0; c < scene.mesh.cells.size(); ++c)
      CHECK(solution.cell_volume[c] ==
            Approx(cases::cell_volume(cases::cell_corners(scene.mesh, c, solution.displacement)))
                .epsilon(1e-12)); // exact integrals both
  }
}

TEST_CASE("the norms of one quadratic element are its field's and not its corners'", "[verification]") {
  const Vector3d edges(2, 3, 5);
  const fem_reference::Cuboid cuboid(2, 0, edges);
  std::vector<double> displacement;
  for (const Vector3d& node : cuboid.nodes()) {
    const double x = edges.x() * node.x();
    for (const double u : {x * x, 0., -1.}) displacement.push_back(u);
  }
  const cases::Scene scene;
  const auto norms = fem_reference::displacement_norms(
      {scene,
       {},
       {Element::q2, cases::CellShape::hexahedron, 2, fem_reference::Pressure::pointwise, 0},
       cuboid.nodes(),
       [&](const fem_reference::CellGeometry& cell) {
         return mechanics::shape_products(cell.n_nodes, cell.n_points, cuboid.values().data(), cell.weights,
                                          1);
       },
       {},
       [&](const auto& action) {
         action({{0, Vector3d::Zero(), Eigen::Matrix3d::Identity()},
                 cuboid.geometry(),
                 displacement.data(),
                 nullptr});
       }},
      nullptr);
  CHECK(norms.root_mean_square == Approx(std::sqrt(16. / 5 + 1)).epsilon(1e-13)); // mean of x⁴
  CHECK(norms.largest == Approx(std::sqrt(17.)));
}

namespace {

/// Root of the mean of |u|² over the block of cells of 1 mm, by the exact mass matrix of 1-D elements.
/// @param degree  2: quadratic elements with all their nodes; 1: trilinear ones on their corners alone
double norm_of_nodes(const std::vector<fem_reference::NodeDisplacement>& nodes, int degree) {
  std::map<std::array<int, 3>, Vector3d> at; // displacements by place in half cells
  for (const auto& node : nodes) {
    const Vector3d place = (2 * node.rest).array().round();
    at[{int(place.x()), int(place.y()), int(place.z())}] = node.displacement;
  }
  const double quadratic[3][3] = {{4, 2, -1}, {2, 16, 2}, {-1, 2, 4}}, linear[2][2] = {{10, 5}, {5, 10}};
  const int n = degree + 1;
  double integral = 0;
  for (int cell = 0; cell < 4 * 2 * 3; ++cell) {
    const std::array<int, 3> corner{2 * (cell % 4), 2 * (cell / 4 % 2), 2 * (cell / 8)};
    for (int a = 0; a < n * n * n; ++a)
      for (int b = 0; b < n * n * n; ++b) {
        std::array<int, 3> first = corner, second = corner;
        double mass = 1;
        for (int axis = 0, p = a, q = b; axis < 3; ++axis, p /= n, q /= n) {
          first[cases::index(axis)] += p % n * (3 - degree);
          second[cases::index(axis)] += q % n * (3 - degree);
          mass *= (degree == 2 ? quadratic[p % n][q % n] : linear[p % n][q % n]) / 30;
        }
        integral += mass * at.at(first).dot(at.at(second));
      }
  }
  return std::sqrt(integral / (4 * 2 * 3));
}

} // namespace

TEST_CASE("the norms of quadratic elements are their field's, on both backends and on finer meshes",
          "[verification]") {
  for (const auto backend : {Backend::assembled, Backend::grid}) {
    Model model(cases::make_scene(bent(Element::q2)), MPI_COMM_SELF, backend);
    const cases::Solution solution = model.solve();
    const auto nodes = model.node_displacements();
    double largest = 0;
    for (const auto& node : nodes) largest = std::max(largest, node.displacement.norm());
    REQUIRE(solution.norms);
    CHECK(solution.norms->root_mean_square ==
          Approx(norm_of_nodes(nodes, 2)).epsilon(1e-12)); // the same integral
    CHECK(solution.norms->largest == Approx(largest).epsilon(1e-14));
    CHECK(std::abs(norm_of_nodes(nodes, 1) / norm_of_nodes(nodes, 2) - 1) > 0.005); // the corners alone
    CHECK_FALSE(solved(bent(Element::q1), backend).norms);                          // the nodes tell it
    // Trilinear elements on the finer mesh have the same nodes.
    Model finer(cases::make_scene(bent(Element::q1, 1)), MPI_COMM_SELF, backend);
    const cases::Solution fine = finer.solve();
    REQUIRE(fine.norms);
    CHECK(fine.norms->root_mean_square == Approx(norm_of_nodes(finer.node_displacements(), 2)).epsilon(0.01));
  }
}
