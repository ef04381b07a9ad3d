#include "msm/design/small_strain.hpp"

#include "mechanics/elastic_moduli.hpp"
#include "msm/design/design.hpp"
#include "msm/model.hpp"
#include "tests/support/bodies.hpp"
#include "tests/support/closed_forms.hpp"
#include "tests/support/linear_tetrahedron.hpp"

#include <catch2/catch.hpp>
#include <fmt/format.h>

using namespace springproof;

using Eigen::Vector3d;

namespace {

constexpr double soft_modulus = 0.3, soft_ratio = 0.35;

msm::DesignResult designed(cases::Design design, const msm::CellVertices& cell = msm::cube(1.3)) {
  msm::DesignRequest request;
  request.material = cases::LinearElastic{soft_modulus, soft_ratio};
  request.cell = cell;
  request.options.design = design;
  return msm::design(request);
}

/// Cells of a box of cubes of 1 mm and the kind of each.
msm::BodyTerms of_box(const std::array<int, 3>& cells, std::vector<msm::CellTerms> kinds) {
  msm::BodyTerms terms{std::move(kinds)};
  for (int k = 0; k < cells[2]; ++k)
    for (int j = 0; j < cells[1]; ++j)
      for (int i = 0; i < cells[0]; ++i) terms.kind_of_cell.push_back((i + j + k) % 2);
  return terms;
}

/// Internal forces of linear tetrahedra of St. Venant-Kirchhoff in the cut cells of a body.
msm::Points finite_element_forces(const cases::Mesh& mesh, const msm::BodyTerms& terms,
                                  const msm::Points& positions, const mechanics::ElasticModuli& moduli) {
  msm::Points forces(positions.size(), Vector3d::Zero());
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    for (const auto& vertices : msm::five_tetrahedra(terms.kind_of_cell[c])) {
      const auto nodes = cases::pick(mesh.cells[c], vertices);
      linear_tetrahedron::Positions rest, x;
      for (std::size_t v = 0; v < 4; ++v) {
        rest[v] = mesh.nodes[cases::index(nodes[v])];
        x[v] = positions[cases::index(nodes[v])];
      }
      const auto of_element = linear_tetrahedron::forces(rest, x, moduli.lambda, moduli.mu);
      for (std::size_t v = 0; v < 4; ++v) forces[cases::index(nodes[v])] += of_element[v];
    }
  return forces;
}

} // namespace

TEST_CASE("the five tetrahedra of a cell fill it, in either kind") {
  for (const int kind : {0, 1}) {
    double sum = 0;
    for (const auto& vertices : msm::five_tetrahedra(kind)) {
      msm::TetrahedronPositions x;
      for (std::size_t v = 0; v < 4; ++v) x[v] = msm::cube(1)[cases::index(vertices[v])];
      CHECK(msm::volume_of(x) > 0);
      sum += msm::volume_of(x);
    }
    CHECK(sum == Approx(1).epsilon(1e-15));
  }
}

TEST_CASE("the periodic lattices of cut cells have the moduli of their formulas", "[verification]") {
  const double tolerance = 1e-3; // relative, of three printed digits
  const msm::LatticeModuli van_gelder = designed(cases::Design::van_gelder).moduli,
                           lloyd = designed(cases::Design::lloyd).moduli,
                           biquadratic = designed(cases::Design::biquadratic).moduli;
  CHECK(van_gelder.youngs_modulus / soft_modulus == Approx(1.200).epsilon(tolerance));
  CHECK(van_gelder.poissons_ratio == Approx(0.200).epsilon(tolerance));
  CHECK(van_gelder.zener == Approx(0.667).epsilon(tolerance));
  CHECK(lloyd.youngs_modulus / soft_modulus == Approx(1.140).epsilon(tolerance));
  CHECK(lloyd.poissons_ratio == Approx(0.237).epsilon(2 * tolerance)); // 0.2366
  CHECK(lloyd.zener == Approx(0.898).epsilon(tolerance));
  CHECK(biquadratic.youngs_modulus == Approx(soft_modulus).epsilon(1e-12)); // linear elements are exact
  CHECK(biquadratic.poissons_ratio == Approx(soft_ratio).epsilon(1e-12));
  CHECK(biquadratic.zener == Approx(1).epsilon(1e-12));
}

TEST_CASE("points inside a lattice of cut cells are in equilibrium under an affine deformation",
          "[verification]") {
  const std::array<int, 3> cells{4, 4, 4};
  const cases::Mesh mesh = cases::make_box_mesh({4, 4, 4}, cells);
  const auto kinds = GENERATE(msm::van_gelder(msm::cube(1), soft_modulus),
                              msm::lloyd(msm::cube(1), soft_modulus), msm::biquadratic(0.3, 0.1));
  const msm::Lattice lattice = msm::make_lattice(mesh, of_box(cells, kinds));
  Eigen::Matrix3d deformation;
  deformation << 1.2, 0.3, -0.1, 0.05, 0.9, 0.2, 0.1, -0.15, 1.1;
  msm::Points positions = lattice.rest;
  for (Vector3d& x : positions) x = deformation * x;
  const msm::Points force = msm::internal_force(lattice, positions);
  double scale = 0;
  for (const Vector3d& f : force) scale = larger(scale, f.norm());
  int n_interior = 0;
  for (std::size_t p = 0; p < force.size(); ++p) {
    const Vector3d& x = lattice.rest[p];
    if (x.minCoeff() < 0.1 || x.maxCoeff() > 3.9) continue;
    ++n_interior;
    CHECK(force[p].norm() <= 1e-13 * scale); // round-off of 18 springs or 32 tetrahedra
  }
  CHECK(n_interior == 27);
}

TEST_CASE("biquadratic springs are linear tetrahedral finite elements of St. Venant-Kirchhoff",
          "[verification]") {
  const std::array<int, 3> cells{3, 3, 3};
  const cases::Case definition = bodies::clamped_box(cells, bodies::shear(2e-3));
  const cases::Scene scene = cases::make_scene(definition);
  const mechanics::ElasticModuli moduli =
      mechanics::elastic_moduli(cases::LinearElastic{soft_modulus, soft_ratio});
  const msm::BodyTerms terms = of_box(cells, msm::biquadratic(moduli.lambda, moduli.mu));
  const msm::Lattice lattice = msm::make_lattice(scene.mesh, terms);

  SECTION("their forces in any state") {
    const msm::Points at = bodies::disturbed(lattice.rest, 0.2);
    const msm::Points forces = msm::internal_force(lattice, at),
                      expected = finite_element_forces(scene.mesh, terms, at, moduli);
    const auto norm = [](const Vector3d& force) { return force.norm(); };
    CHECK(largest_difference(forces, expected, norm) <= 1e-14); // N, of up to 0.2: sums of 32 tetrahedra
  }
  SECTION("their equilibrium") {
    const cases::Solution solution = msm::Model(scene, terms).solve();
    REQUIRE(solution.status == cases::Status::converged);
    msm::Points at = lattice.rest;
    for (std::size_t p = 0; p < at.size(); ++p) at[p] += solution.displacement[p];
    const msm::Points internal = finite_element_forces(scene.mesh, terms, at, moduli);
    const double load = 2e-3;
    for (std::size_t p = 0; p < at.size(); ++p) {
      const Vector3d& x = lattice.rest[p];
      if (x.z() < 0.1) continue; // held
      const Vector3d applied = x.z() > 2.9 ? Vector3d(load, 0, 0) : Vector3d::Zero();
      CHECK((internal[p] + applied).norm() <= 1e-8 * load); // Newton ends at 1e-9 of the whole load
    }
  }
}

TEST_CASE("springs that others published have the moduli that they are published with", "[verification]") {
  const double edge = 1.3, exact = 1e-14; // closed forms
  SECTION("ladd_kinney: E and 1/4, isotropic") {
    const msm::LatticeModuli moduli = closed::lattice_moduli(msm::ladd_kinney(soft_modulus, edge), edge);
    CHECK(moduli.youngs_modulus == Approx(soft_modulus).epsilon(exact));
    CHECK(moduli.poissons_ratio == Approx(0.25).epsilon(exact));
    CHECK(moduli.zener == Approx(1).epsilon(exact));
  }
  SECTION("baudet: isotropic with E at 1/4, where nothing is corrected") {
    const msm::LatticeModuli moduli = closed::lattice_moduli(msm::baudet(soft_modulus, 0.25, edge), edge);
    CHECK(moduli.youngs_modulus == Approx(soft_modulus).epsilon(exact));
    CHECK(moduli.zener == Approx(1).epsilon(exact));
    CHECK(msm::baudet(soft_modulus, 0.25, edge).face_diagonal == 0);
  }
  SECTION("uniform: E along the axes far from the boundary") {
    const double k = msm::uniform_stiffness(soft_modulus, edge);
    CHECK(closed::lattice_moduli(msm::uniform_springs(k), edge).youngs_modulus ==
          Approx(soft_modulus).epsilon(exact));
  }
}

TEST_CASE(
    "baudet says that its cell is a mechanism, and that its correction is left out but where there is none") {
  msm::DesignRequest request;
  request.options.design = cases::Design::baudet;
  request.material = cases::LinearElastic{soft_modulus, 0.25};
  const std::string mechanism = "3 zero-energy modes"; // 16 springs, 15 of them independent, 18 motions
  CHECK_THAT(fmt::format("{}", fmt::join(msm::design(request).warnings, "; ")),
             Catch::Contains(mechanism) && !Catch::Contains("left out"));
  request.material = cases::LinearElastic{soft_modulus, 0.35};
  CHECK_THAT(fmt::format("{}", fmt::join(msm::design(request).warnings, "; ")),
             Catch::Contains(mechanism) && Catch::Contains("left out"));
}

TEST_CASE("the published designs take an incompressible material, and none warns of a mechanism") {
  const auto design = GENERATE(cases::Design::ladd_kinney, cases::Design::uniform, cases::Design::van_gelder,
                               cases::Design::lloyd, cases::Design::biquadratic);
  msm::DesignRequest request;
  request.options.design = design;
  request.material = bodies::thesis_ogden;
  const msm::DesignResult result = msm::design(request);
  for (const std::string& warning : result.warnings) CHECK_THAT(warning, !Catch::Contains("mechanism"));
  CHECK(result.moduli.youngs_modulus > 0);
}

TEST_CASE("given stiffnesses by axis are those of the springs along and across it") {
  msm::DesignRequest request;
  request.material = cases::LinearElastic{soft_modulus, soft_ratio};
  request.options.design = cases::Design::given;
  request.options.axis_stiffness = {1, 2, 3, 4, 5, 6, 7};
  const msm::DesignResult result = msm::design(request);
  REQUIRE(result.springs.terms());
  const auto stiffness_along = [&](const Vector3d& direction) {
    double sum = 0;
    for (const msm::CellSpring& spring : result.springs.terms()->kinds.front().springs) {
      const Vector3d d =
          msm::cube(1)[cases::index(spring.vertices[1])] - msm::cube(1)[cases::index(spring.vertices[0])];
      if (d.cwiseAbs() == direction) sum += 1e3 * spring.stiffness;
    }
    return sum;
  };
  const double tolerance = 1e-14; // sums of four
  CHECK(stiffness_along({1, 0, 0}) == Approx(4 * 1).epsilon(tolerance));
  CHECK(stiffness_along({0, 1, 0}) == Approx(4 * 2).epsilon(tolerance));
  CHECK(stiffness_along({0, 0, 1}) == Approx(4 * 3).epsilon(tolerance));
  CHECK(stiffness_along({0, 1, 1}) ==
        Approx(4 * 4).epsilon(tolerance)); // the two faces across x, two diagonals each
  CHECK(stiffness_along({1, 0, 1}) == Approx(4 * 5).epsilon(tolerance));
  CHECK(stiffness_along({1, 1, 0}) == Approx(4 * 6).epsilon(tolerance));
  CHECK(stiffness_along({1, 1, 1}) == Approx(4 * 7).epsilon(tolerance));
}
