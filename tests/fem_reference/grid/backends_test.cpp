// The two backends of the finite elements are the same equations: their answers agree to 1e-8.

#include "fem_reference/grid/grid_body.hpp"
#include "fem_reference/model.hpp"

#include "tests/fem_reference/scenes.hpp"
#include "tests/support/largest.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace springproof;

using cases::Element;
using Eigen::Vector3d;
using fem_reference::Backend;
using scenes::LoadSet;
using scenes::Test;

namespace two_backends {

namespace {

constexpr double usual_residual = 1e-10; ///< relative to the load

cases::Solution solve(const cases::Scene& scene, Backend backend, double residual = usual_residual) {
  auto settings = fem_reference::default_settings();
  settings.tolerance = residual;
  fem_reference::Model model(scene, MPI_COMM_SELF, backend);
  cases::Solution solution = model.solve(settings);
  solution.fields = model.fields(nullptr);
  return solution;
}

/// Tolerance: both stop at a residual that the soft modes of these bodies amplify by less than 1e-8 /
/// residual.
void agree(const cases::Scene& scene, double residual = usual_residual) {
  const cases::Solution assembled = solve(scene, Backend::assembled, residual),
                        grid = solve(scene, Backend::grid, residual);
  REQUIRE(grid.displacement.size() == assembled.displacement.size());
  double largest = 0, difference = 0;
  for (std::size_t n = 0; n < assembled.displacement.size(); ++n) {
    largest = larger(largest, assembled.displacement[n].norm());
    difference = larger(difference, (assembled.displacement[n] - grid.displacement[n]).norm());
  }
  CAPTURE(largest, difference, assembled.newton_iterations, grid.newton_iterations, grid.linear_iterations);
  CHECK(largest > 0);
  CHECK(difference <= 1e-8 * largest);
  CHECK(grid.unknowns == assembled.unknowns);
  CHECK(grid.negative_eigenvalues == assembled.negative_eigenvalues);
  CHECK(grid.inverted_cells == assembled.inverted_cells);
  CHECK(grid.factorisations == 0);
  REQUIRE(grid.cell_volume.size() == assembled.cell_volume.size());
  for (std::size_t c = 0; c < grid.cell_volume.size(); ++c)
    CHECK(std::abs(grid.cell_volume[c] - assembled.cell_volume[c]) <= 1e-7 * assembled.cell_volume[c]);
  // strains are differences of displacements that agree to 1e-8, over a cell's edge
  CHECK(largest_difference(*grid.fields, *assembled.fields) <= 1e-6);
}

cases::Case cube(cases::Formulation formulation, Element element, Test test = Test::shear,
                 LoadSet set = LoadSet::large) {
  cases::Material material = scenes::thesis_elastic();
  if (formulation == cases::Formulation::hyperelastic) {
    cases::Ogden ogden = scenes::thesis_ogden();
    ogden.bulk_modulus = 0.5;
    material = ogden;
  }
  auto definition = scenes::cube(test, set, material, formulation, element, 5);
  // there are fewer nodes; point forces on the vertices of quadratic elements tear a body that has no energy
  for (auto& load : definition.loads) load.scale(121. / 36 / (element == Element::q2 ? 4 : 2));
  return definition;
}

void agree_for_every_law_and_element(std::initializer_list<Test> tests) {
  for (const auto formulation : {cases::Formulation::small_strain, cases::Formulation::saint_venant_kirchhoff,
                                 cases::Formulation::log_strain, cases::Formulation::hyperelastic})
    for (const auto element :
         {Element::q1, Element::q1_bbar, Element::q1_p0, Element::q1_wilson, Element::q2})
      for (const auto test : tests) {
        if (formulation == cases::Formulation::saint_venant_kirchhoff &&
            (element == Element::q1_bbar || element == Element::q1_p0))
          continue;
        CAPTURE(cases::name_of(formulation), cases::name_of(element), int(test));
        agree(cases::make_scene(cube(formulation, element, test)));
      }
}

} // namespace

TEST_CASE("both backends find the same equilibrium under torsion, whatever the law and the element",
          "[verification][kernels][long]") {
  agree_for_every_law_and_element({Test::torsion});
}

TEST_CASE("both backends find the same equilibrium under tension and shear, whatever the law and the element",
          "[verification][long]") {
  agree_for_every_law_and_element({Test::tensile, Test::shear});
}

TEST_CASE("both backends agree on flat cells, tractions, torques, symmetry and supports of one component",
          "[verification][long]") {
  const auto element = GENERATE(Element::q1_bbar, Element::q1_wilson, Element::q2);
  CAPTURE(cases::name_of(element));
  auto definition = cube(cases::Formulation::log_strain, element);
  definition.body = cases::Box{Vector3d(10, 6, 4), {7, 6, 9}};
  definition.fixed.clear();
  for (const char* face : {"x-", "y-", "z-"}) {
    definition.fixed.push_back({{face}, {face[0] == 'x', face[0] == 'y', face[0] == 'z'}});
  }
  definition.loads = {scenes::traction("x+", {0.02, 0.003, -0.002})};
  agree(cases::make_scene(definition));

  definition.symmetry = {definition.fixed.front()};
  definition.fixed.erase(definition.fixed.begin());
  agree(cases::make_scene(definition));

  auto twisted = cube(cases::Formulation::hyperelastic, element == Element::q1_bbar ? Element::q1 : element);
  twisted.loads = {{{"z+"}, cases::loads::Torque{3, Eigen::Vector3d::UnitZ(), Vector3d(5, 5, 10)}}};
  agree(cases::make_scene(twisted));
}

TEST_CASE("both backends agree where supports move and turn", "[verification][long]") {
  const int motion = GENERATE(0, 1, 2);
  for (const auto element : {Element::q1, Element::q1_bbar, Element::q1_wilson, Element::q2}) {
    auto definition = cube(cases::Formulation::log_strain, element);
    CAPTURE(motion, cases::name_of(element));
    cases::Moved moved;
    moved.region.name = "z+";
    if (motion == 0) moved.displacement = Vector3d(2, 0.5, -1);
    if (motion == 1) {
      moved.angle = 30;
      moved.centre = Vector3d(5, 5, 10);
    }
    if (motion == 2) { // pressed, and free to slide
      moved.components = {false, false, true};
      moved.displacement = Vector3d(0, 0, -2);
    }
    definition.moved = {moved};
    definition.loads.clear();
    agree(cases::make_scene(definition));
  }
}

TEST_CASE("both backends agree on a body with holes, of two materials, and refined", "[verification][long]") {
  const auto element = GENERATE(Element::q1_bbar, Element::q1_wilson, Element::q2);
  CAPTURE(cases::name_of(element));
  auto definition = cube(cases::Formulation::log_strain, element);
  cases::RegionMaterial stiff;
  stiff.material = cases::LinearElastic{3, 0.2};
  stiff.lower = Vector3d(2, -INFINITY, 4);
  stiff.upper = Vector3d(6, INFINITY, INFINITY);
  definition.region_materials = {stiff};
  definition.loads = {scenes::traction("z+", {0.01, 0, -0.01})};
  agree(cases::make_scene(definition));
  definition.fem.refine = 1;
  agree(cases::make_scene(definition));

  cases::Scene scene = cases::make_scene(
      cube(cases::Formulation::hyperelastic, element == Element::q1_bbar ? Element::q1_p0 : element));
  cases::Grid grid = *scene.mesh.grid;
  grid.present.assign(grid.n_lattice_cells(), true);
  for (const std::size_t hole : {31u, 32u, 36u, 57u, 62u, 124u, 119u}) grid.present[hole] = false;
  scene.mesh = cases::make_grid_mesh(grid);
  cases::Region bottom, top;
  bottom.name = "z-";
  top.name = "z+";
  scene.constrained = {{cases::select(scene.mesh, bottom), {true, true, true}}};
  scene.loads = {{cases::select(scene.mesh, top), scenes::traction("z+", {0.002, 0.001, 0})}};
  agree(scene);
}

TEST_CASE("both backends agree on gravity, of two materials and of weights", "[verification][long]") {
  for (const auto element : {Element::q1_bbar, Element::q1_wilson, Element::q2}) {
    CAPTURE(cases::name_of(element));
    auto definition = cube(cases::Formulation::log_strain, element);
    definition.material_dynamics.density = 1e5; // kg/m³: a soft block of 1 cm weighs little
    cases::RegionMaterial heavy;
    heavy.material = cases::LinearElastic{3, 0.2};
    heavy.dynamics.density = 4e5;
    heavy.lower = Vector3d(2, -INFINITY, 4);
    heavy.upper = Vector3d(6, INFINITY, INFINITY);
    definition.region_materials = {heavy};
    definition.masses.emplace_back();
    definition.masses.back().region.name = "z+";
    definition.masses.back().mass = element == Element::q1_bbar ? 0.1 : 0.02; // kg; softer vertices tear
    definition.loads = {{{}, cases::loads::Gravity{Vector3d(20, 5, -9.81)}}};
    agree(cases::make_scene(definition));
  }
}

TEST_CASE("both backends count the negative eigenvalues of a column pressed beyond its Euler load",
          "[verification]") {
  const auto element = GENERATE(Element::q1_bbar, Element::q1_wilson);
  const double euler = std::acos(-1.) * std::acos(-1.) / 12 / 400; // N, at E = 1 MPa
  for (const double fraction : {0.8, 1.6}) {
    auto definition = cube(cases::Formulation::log_strain, element);
    CAPTURE(cases::name_of(element), fraction);
    definition.body = cases::Box{Vector3d(1, 1, 10), {3, 3, 30}};
    definition.material = cases::LinearElastic{1, 0};
    definition.loads = {scenes::traction("z+", {0, 0, -fraction * euler})};
    const cases::Scene scene = cases::make_scene(definition);
    agree(scene, 1e-12); // the column bends 400 times as easily as it is pressed
    CHECK(solve(scene, Backend::grid).negative_eigenvalues == (fraction < 1 ? 0 : 2));
  }
}

TEST_CASE(
    "a load that cannot be carried is refused by both backends, at the same load, with the work it took") {
  const auto element = GENERATE(Element::q1_bbar, Element::q1_wilson);
  CAPTURE(cases::name_of(element));
  auto definition = cube(cases::Formulation::log_strain, element, Test::tensile);
  for (auto& load : definition.loads) load.scale(10);
  const cases::Scene scene = cases::make_scene(definition);
  const std::vector<bool> constrained = cases::constrained_dofs(scene);
  const auto n_free = std::size_t(std::count(constrained.begin(), constrained.end(), false));
  double reached[2] = {0, 1};
  for (const auto backend : {Backend::assembled, Backend::grid}) try {
      solve(scene, backend);
      FAIL("was carried");
    } catch (const cases::SolveError& error) {
      reached[backend == Backend::grid] = error.load_reached();
      const cases::Solution& work = error.so_far();
      CHECK(work.unknowns == n_free);
      CHECK(work.newton_iterations > 10);
      CHECK(work.force_evaluations > work.newton_iterations);
      CHECK((backend == Backend::grid ? work.linear_iterations : work.factorisations) >=
            work.newton_iterations);
    }
  CAPTURE(reached[0], reached[1]);
  CHECK(std::abs(reached[0] - reached[1]) <= 2. / 512); // two of the smallest load steps
}

TEST_CASE("a load that cannot be carried is not tried again with a factorisation: the body is to blame",
          "[long]") {
  auto definition = cube(cases::Formulation::log_strain, Element::q1_bbar);
  const int n = GENERATE(8, 12);
  definition.body = cases::Box{Vector3d(10, 10, 10), {n, n, n}};
  definition.loads = {scenes::traction("z+", {0.3, 0, 0})};
  try {
    solve(cases::make_scene(definition), Backend::automatic);
    FAIL("was carried");
  } catch (const cases::SolveError& error) {
    CHECK(error.so_far().linear_iterations > 0);
    CHECK(error.so_far().factorisations == 0);
  }
}

TEST_CASE("a long body of nu = 0.499 bends alike on both backends", "[verification]") {
  auto definition = cube(cases::Formulation::small_strain, Element::q1_bbar);
  definition.body = cases::Box{Vector3d(100, 15, 30), {20, 3, 6}};
  definition.material = cases::LinearElastic{0.26, 0.499};
  definition.fixed.front().region.name = "x-";
  definition.fixed.front().components = {true, true, true};
  definition.loads = {scenes::traction("x+", {0, 0, -0.0003})};
  const cases::Scene scene = cases::make_scene(definition);
  const auto grid = solve(scene, Backend::automatic), assembled = solve(scene, Backend::assembled);
  CHECK(assembled.factorisations > 0);
  const double largest = largest_displacement(assembled);
  CHECK(largest > 0);
  CHECK(largest_difference(assembled, grid) <= 1e-8 * largest); // as in agree(), amplified by less than 100
}

TEST_CASE("the grid's backend knows whether its multigrid serves a body") {
  for (const bool is_compressible : {true, false}) {
    auto definition = cube(cases::Formulation::log_strain, Element::q1_bbar);
    definition.material = scenes::thesis_elastic(is_compressible ? 0.35 : 0.4999999);
    fem_reference::grid::GridBody body(cases::make_scene(definition), MPI_COMM_SELF, 1);
    CHECK(body.can_leave_rest() == is_compressible);
  }
}

TEST_CASE("a body that the grid's multigrid does not serve is solved by the other backend, which is said",
          "[verification]") {
  auto definition = cube(cases::Formulation::small_strain, Element::q1);
  std::get<cases::Box>(definition.body).cells = {8, 8, 8};
  definition.region_materials.push_back({cases::LinearElastic{3e7, 0.35}, "", {2, 2, 2}, {6, 6, 6}, {}});
  const cases::Scene scene = cases::make_scene(definition);
  CHECK_THROWS_AS(solve(scene, Backend::grid), cases::SolveError);
  const cases::Solution found = solve(scene, Backend::automatic),
                        assembled = solve(scene, Backend::assembled);
  CHECK_THAT(found.message, Catch::Contains("by the assembled tangent"));
  CHECK(assembled.message.empty());
  CHECK(found.displacement == assembled.displacement);
}

} // namespace two_backends
