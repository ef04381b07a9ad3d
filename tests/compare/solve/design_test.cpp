#include "compare/solve/springs.hpp"

#include "cases/case/readers.hpp"
#include "compare/thesis/regenerate.hpp"
#include "tests/support/bodies.hpp"
#include "tests/support/closed_forms.hpp"
#include "tests/support/tetrahedra.hpp"

#include <catch2/catch.hpp>

using namespace springproof;

namespace {

msm::DesignResult linear_design(double youngs_modulus, double poissons_ratio, double edge) {
  cases::Msm options;
  options.design = cases::Design::linear_method;
  return msm::design(compare::design_request(cases::LinearElastic{youngs_modulus, poissons_ratio},
                                             msm::cube(edge), options));
}

} // namespace

TEST_CASE("the linear method regenerates all 33 entries of Table 4.1", "[verification]") {
  int n = 0;
  const double tolerance =
      0.0015; // three printed digits, and two entries whose last digit was rounded otherwise
  for (const compare::PublishedFigure& figure : compare::published_figures()) {
    if (figure.table != "4.1") continue;
    ++n;
    CAPTURE(figure.poissons_ratio, figure.measure);
    const msm::CellStiffness pseudo =
        closed::pseudo_stiffness(linear_design(1, figure.poissons_ratio, 2).stiffness, 1, 2);
    const double computed = figure.measure == "edge"            ? pseudo.edge
                            : figure.measure == "face_diagonal" ? pseudo.face_diagonal
                                                                : pseudo.internal_diagonal;
    CHECK(computed == Approx(figure.value).margin(tolerance));
  }
  CHECK(n == 3 * 11);
}

TEST_CASE("pseudo-stiffnesses depend neither on Young's modulus nor on the edge", "[verification]") {
  const msm::CellStiffness one = closed::pseudo_stiffness(linear_design(1, 0.3, 2).stiffness, 1, 2);
  const msm::CellStiffness other = closed::pseudo_stiffness(linear_design(0.3, 0.3, 0.7).stiffness, 0.3, 0.7);
  CHECK(other.edge == Approx(one.edge).epsilon(1e-12)); // a well-conditioned least-squares problem: round-off
  CHECK(other.internal_diagonal == Approx(one.internal_diagonal).epsilon(1e-12));
}

// What else answers without a design that is named: case files, `new`, Python's design(), all by
// default_design(); `tables`, `sweep` and `run --designs` name theirs.
TEST_CASE(
    "the design without a name has the material's moduli and a lattice that is stable over the strains of "
    "its exponents") {
  const bool has_nodal_forces = GENERATE(false, true);
  const auto designed = [&](const cases::Material& material) {
    cases::Msm options;
    options.design = cases::default_design({material}, {}, has_nodal_forces);
    return std::pair(options.design, msm::design(compare::design_request(material, msm::cube(1), options)));
  };
  for (int percent = 0; percent < 50; ++percent) {
    const double nu = percent / 100.;
    CAPTURE(nu);
    const auto [name, result] = designed(cases::LinearElastic{0.005, nu});
    CHECK(name == (!has_nodal_forces          ? cases::Design::midline
                   : nu > 0.245 && nu < 0.355 ? cases::Design::matched
                                              : cases::Design::hybrid));
    CHECK(result.misfit->largest < 1e-9); // closed forms
    for (const std::string& warning : result.warnings) CHECK_THAT(warning, Catch::StartsWith("volume term"));
    if (nu >= 0.255) CHECK(result.warnings.empty()); // below 0.25 the volume term is negative
  }
  for (const double alpha : {-10., -2., 0.1, 2., 5.7, 25.}) {
    CAPTURE(alpha);
    const auto [name, result] = designed(cases::Ogden{{0.04}, {alpha}, std::nullopt});
    CHECK(name == (has_nodal_forces ? cases::Design::matched : cases::Design::midline));
    CHECK(result.misfit->largest < 0.003); // lambda = 200 mu stands for incompressible: nu = 0.4975
    CHECK(result.warnings.empty());
  }
  CHECK(cases::default_design({cases::LinearElastic{0.3, -0.1}}, {}, has_nodal_forces) ==
        cases::Design::moduli); // hybrid has it not
  if (!has_nodal_forces) return;
  CHECK(cases::default_design({cases::LinearElastic{0.3, 0.3}, cases::LinearElastic{3, 0.45}}, {}, true) ==
        cases::Design::hybrid); // default for both materials
  CHECK(cases::default_design({cases::LinearElastic{0.3, 0.45}}, 0.3, true) == cases::Design::matched);
  CHECK(cases::default_design({cases::Ogden{{0.04}, {2}, 0.05}}, {}, true) ==
        cases::Design::hybrid); // nu = 0.18
}

TEST_CASE("a box's design is that of its cell") {
  cases::Case definition;
  definition.body = cases::Box{{3, 2, 1}, {3, 2, 1}};
  definition.material = cases::LinearElastic{0.3, 0.35};
  definition.msm.design = cases::Design::linear_method;
  const msm::DesignResult result = compare::design_for(cases::make_scene(definition));
  CHECK(result.stiffness.edge ==
        Approx(linear_design(0.3, 0.35, 1).stiffness.edge).epsilon(1e-14)); // the same sums
  // Rounded to whole N/m these are the stiffnesses that the thesis prints (eq. 5.16).
  CHECK(std::lround(1000 * result.stiffness.edge) == 31);
  CHECK(std::lround(1000 * result.stiffness.face_diagonal) == 47);
  CHECK(std::lround(1000 * result.stiffness.internal_diagonal) == 33);
}

TEST_CASE("every cell of an irregular mesh gets springs of its own, near those of a cube") {
  cases::Case definition;
  definition.body = cases::Box{{2, 2, 2}, {{2, 2, 2}}};
  definition.material = cases::LinearElastic{0.3, 0.35};
  definition.msm.design = cases::Design::linear_method;
  cases::Scene scene = cases::make_scene(definition);
  const msm::CellStiffness cube = compare::design_for(scene).stiffness;
  scene.mesh.grid.reset();
  for (Eigen::Vector3d& x : scene.mesh.nodes.stored())
    x += 0.03 * Eigen::Vector3d(std::sin(5 * x.y()), std::sin(4 * x.z()), 0);
  const msm::DesignResult design = compare::design_for(scene);
  REQUIRE(design.springs.cells());
  REQUIRE(design.springs.cells()->size() == 8);
  // Whatever the mesh: springs alone have no nu = 0.35.
  CHECK_THAT(design.warnings.at(0), Catch::StartsWith("8 of 8 cells, the worst: the lattice's moduli"));
  for (const msm::CellStiffness& k : *design.springs.cells()) {
    CHECK(k.edge == Approx(cube.edge).epsilon(0.2)); // shears of up to 15 %
    CHECK(k.edge != cube.edge);
  }
}

TEST_CASE("the hybrid's springs on an irregular mesh are designed for the mesh as a whole, and say how well "
          "they fit") {
  cases::Case definition;
  definition.body = cases::Box{{6, 6, 6}, {{6, 6, 6}}};
  definition.material = cases::LinearElastic{0.3, 0.35};
  definition.msm.design = GENERATE(cases::Design::hybrid, cases::Design::matched, cases::Design::midline);
  cases::Scene scene = cases::make_scene(definition);
  scene.mesh.grid.reset();
  for (Eigen::Vector3d& x : scene.mesh.nodes.stored())
    x += 0.1 * Eigen::Vector3d(std::sin(5 * x.y()), std::sin(4 * x.z()), 0);
  const msm::DesignResult design = compare::design_for(scene);
  REQUIRE(design.springs.terms());
  CHECK(design.springs.terms()->kinds.size() == 216);
  CHECK_THAT(design.warnings.at(0), Catch::StartsWith("springs cannot follow the shapes of this mesh"));
  REQUIRE(design.misfit);
  CHECK(design.misfit->largest < 0.15); // shears of up to 45 %
  CHECK(design.springs.terms()->kinds.front().midlines.empty() ==
        (definition.msm.design != cases::Design::midline));
}

TEST_CASE("springs on tetrahedra take the designs that edges can have, and refuse the others by name") {
  cases::Case definition;
  definition.body = cases::Box{{2, 2, 2}, {{2, 2, 2}}};
  definition.material = cases::LinearElastic{0.3, 0.35};
  cases::Scene scene = cases::make_scene(definition);
  scene.mesh = bodies::box_of_tetrahedra({2, 2, 2});
  using D = cases::Design;
  for (const D one :
       {D::hybrid, D::matched, D::midline, D::uniform, D::van_gelder, D::lloyd, D::biquadratic}) {
    const msm::DesignResult design = compare::design_for(compare::with_design(scene, one));
    REQUIRE(design.springs.terms());
    CHECK(design.springs.terms()->kinds.size() == scene.mesh.cells.size());
    REQUIRE(design.misfit);
    if (one == D::biquadratic) CHECK(design.misfit->largest < 1e-12); // linear finite elements
    const bool is_at_nodes = one == D::hybrid || one == D::matched || one == D::midline;
    CHECK(msm::has_volume_patches(design.springs) == is_at_nodes);
  }
  for (const bool is_auto : {false, true}) {
    cases::Msm options = compare::with_design(scene, D::midline).definition.msm;
    options.has_auto_design = is_auto;
    cases::settle_design(options, true);
    CHECK(options.design == (is_auto ? D::hybrid : D::midline));
  }
  for (const D one : {D::linear_method, D::moduli, D::multi_load, D::ladd_kinney, D::baudet})
    CHECK_THROWS_WITH(compare::design_for(compare::with_design(scene, one)),
                      Catch::Contains("the others are for hexahedra") && Catch::Contains("\"biquadratic\""));
}

// The energies, the reactions and the stress of volume terms at nodes come from their nodes' patches.
TEST_CASE("fields of springs on tetrahedra have the lattice's energy and forces") {
  cases::Case definition;
  definition.body = cases::Box{{2, 2, 2}, {{2, 2, 2}}};
  definition.material = cases::LinearElastic{0.3, 0.45};
  definition.msm.design = cases::Design::hybrid;
  cases::Scene scene = cases::make_scene(definition);
  scene.mesh = bodies::box_of_tetrahedra({2, 2, 2});
  const msm::SpringBody springs = compare::design_for(scene).springs;
  const msm::Lattice lattice = msm::make_lattice(scene.mesh, springs);
  cases::Solution solution;
  const double size = GENERATE(0.1, 1e-7); // mm
  solution.displacement = bodies::disturbed(msm::Points(lattice.rest.size(), Eigen::Vector3d::Zero()), size);
  const cases::Fields fields = msm::fields(scene, springs, solution);
  const double energy = msm::energy_at(lattice, solution.displacement);
  double sum = 0;
  for (std::size_t c = 0; c < scene.mesh.cells.size(); ++c) sum += fields.strain_energy[c];
  CHECK(fields.total_energy == Approx(energy).epsilon(1e-6)); // small motions: to the size over the cells'
  CHECK(sum == Approx(energy).epsilon(1e-6));
}

// Other designs sum a shared spring over its cells, so that the half body has half of it already. Whatever
// else is counted by node or cell on such planes (loads, patches, supports, masses, fields) is checked in
// tests/faults/attempts_same.py.
TEST_CASE("a quarter of a body between planes of symmetry answers as the whole, with springs that are whole "
          "at the boundary",
          "[verification]") {
  const auto solved = [](const std::array<int, 3>& cells, const std::vector<std::string>& planes) {
    cases::Case box = bodies::clamped_box(cells, {});
    box.loads = {{bodies::region("z+"), cases::loads::Traction{{0, 0, 0.004}}}};
    box.msm.design = cases::Design::uniform;
    for (const std::string& plane : planes)
      box.symmetry.push_back({bodies::region(plane), {plane[0] == 'x', plane[0] == 'y', false}});
    const cases::Scene scene = cases::make_scene(box);
    std::optional<msm::DesignResult> design;
    const cases::Solution solution = compare::solve_springs(scene, 1, design).solution;
    REQUIRE(solution.status == cases::Status::converged);
    std::vector<Eigen::Vector3d> of_edge;
    for (const int node : cases::select(scene.mesh, bodies::region("x+ y+")).nodes)
      of_edge.push_back(solution.displacement[cases::index(node)]);
    return of_edge;
  };
  const auto whole = solved({4, 2, 3}, {}), quarter = solved({2, 1, 3}, {"x-", "y-"});
  REQUIRE(whole.size() == quarter.size());
  for (std::size_t n = 0; n < whole.size(); ++n)
    CHECK((whole[n] - quarter[n]).norm() <= 1e-9 * whole.back().norm()); // Newton's method ends below
}
