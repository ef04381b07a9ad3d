#include "fem_reference/model.hpp"

#include "grid/moving_block.hpp"
#include "tests/support/largest.hpp"
#include "tests/support/scene_in_tetrahedra.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

using namespace springproof;

using Eigen::Vector3d;

// Run by CTest under mpirun on two ranks, where the communicators differ; alone it would compare a solve with
// itself.
TEST_CASE("two ranks and one find the same displacement and cell volumes", "[.][ranks]") {
  int n_ranks = 0;
  MPI_Comm_size(MPI_COMM_WORLD, &n_ranks);
  REQUIRE(n_ranks == 2);
  struct Combination {
    cases::Formulation formulation;
    cases::Element element;
    int cells;
  };
  using cases::Element;
  using cases::Formulation;
  const Combination c = GENERATE(Combination{Formulation::small_strain, Element::q1, 10},
                                 Combination{Formulation::small_strain, Element::q1_bbar, 10},
                                 Combination{Formulation::saint_venant_kirchhoff, Element::q2, 3},
                                 Combination{Formulation::log_strain, Element::q1_bbar, 4},
                                 Combination{Formulation::log_strain, Element::q1_wilson, 4},
                                 Combination{Formulation::hyperelastic, Element::q1_p0, 4},
                                 Combination{Formulation::hyperelastic, Element::q2_p1, 2},
                                 Combination{Formulation::small_strain, Element::p1, 4},
                                 Combination{Formulation::log_strain, Element::p2, 3},
                                 Combination{Formulation::hyperelastic, Element::p2_p0, 2},
                                 Combination{Formulation::log_strain, Element::p2_p1, 2},
                                 Combination{Formulation::hyperelastic, Element::p2_p1, 2});
  cases::Material material = scenes::thesis_elastic();
  if (c.formulation == Formulation::hyperelastic) material = scenes::thesis_ogden();
  const auto scene = tetrahedra::make_scene(scenes::cube(scenes::Test::torsion, scenes::LoadSet::small,
                                                         material, c.formulation, c.element, c.cells));
  fem_reference::Model shared(scene, MPI_COMM_WORLD), own(scene, MPI_COMM_SELF);
  const auto together = shared.solve(), alone = own.solve();
  // stiff pressures amplify 1e-10
  CHECK(largest_difference(own.fields(nullptr), shared.fields(together.sharing.get()),
                           part_of(alone, together)) <= 1e-8);
  CHECK(largest_difference(alone, together) <= 1e-10);        // mm, as asked; displacements are of order 1 mm
  CHECK(largest_volume_difference(alone, together) <= 1e-10); // mm³; cells are of the order 1 to 100 mm³
  CHECK(alone.unknowns == together.unknowns);
  CHECK(alone.negative_eigenvalues == together.negative_eigenvalues);
}

namespace {

cases::Case small_block(const Vector3d& size, const std::array<int, 3>& cells,
                        cases::Element element = cases::Element::q1_bbar) {
  auto definition = scenes::cube(scenes::Test::shear, scenes::LoadSet::small, scenes::thesis_elastic(),
                                 cases::Formulation::log_strain, element, 2);
  definition.body = cases::Box{size, cells};
  definition.loads = {scenes::traction("z+", {0.006, 0.001, -0.002})};
  return definition;
}

/// Boundaries between the ranks at even and at odd planes; grids that are not coarsened along z, and too few
/// planes for every rank.
std::vector<cases::Scene> scenes_for_ranks() {
  std::vector<cases::Scene> scenes;
  for (const auto& cells : {std::array<int, 3>{8, 7, 13}, std::array<int, 3>{9, 9, 20},
                            std::array<int, 3>{16, 16, 7}, std::array<int, 3>{20, 20, 2}})
    scenes.push_back(cases::make_scene(small_block({10, 10, 10}, cells)));
  scenes.push_back(cases::make_scene(small_block({10, 10, 10}, {4, 4, 9}, cases::Element::q2)));
  scenes.push_back(cases::make_scene(small_block({10, 10, 10}, {8, 7, 13}, cases::Element::q1_wilson)));

  auto refined = small_block({10, 10, 10}, {4, 5, 7});
  cases::RegionMaterial stiff;
  stiff.material = cases::LinearElastic{3, 0.2};
  stiff.lower = Vector3d(2, -INFINITY, 4);
  stiff.upper = Vector3d(6, INFINITY, INFINITY);
  refined.region_materials = {stiff};
  refined.fem.refine = 1;
  scenes.push_back(cases::make_scene(refined));

  for (const auto element : {cases::Element::q1_p0, cases::Element::q2}) {
    const bool is_quadratic = element == cases::Element::q2;
    auto moved = small_block(
        {10, 10, 10}, is_quadratic ? std::array<int, 3>{4, 4, 6} : std::array<int, 3>{8, 8, 11}, element);
    moved.material = scenes::thesis_elastic(0.48);
    moved.loads.clear();
    cases::Moved turned;
    turned.region.name = "z+";
    turned.angle = 20;
    turned.centre = Vector3d(5, 5, 10);
    turned.displacement = Vector3d(0.3, 0, -0.5);
    moved.moved = {turned};
    scenes.push_back(cases::make_scene(moved));
  }

  cases::Scene mask = cases::make_scene(small_block({10, 10, 10}, {8, 8, 12}));
  cases::Grid grid = *mask.mesh.grid;
  grid.present.assign(grid.n_lattice_cells(), true);
  for (std::size_t cell = 70; cell < 700; cell += 7) grid.present[cell] = false;
  mask.mesh = cases::make_grid_mesh(grid);
  cases::Region bottom, top;
  bottom.name = "z-";
  top.name = "z+";
  mask.constrained = {{cases::select(mask.mesh, bottom), {true, true, true}}};
  mask.loads = {{cases::select(mask.mesh, top), mask.definition.loads.front()}};
  scenes.push_back(mask);

  auto column = small_block({1, 1, 10}, {4, 4, 40});
  column.material = cases::LinearElastic{1, 0};
  column.loads.front().kind =
      cases::loads::Traction{{0, 0, -0.0033}}; // 1.6 times the Euler load of both directions
  scenes.push_back(cases::make_scene(column));
  return scenes;
}

} // namespace

TEST_CASE("the grid's backend has the same answer on any number of ranks", "[.][ranks][grid_ranks]") {
  const auto scenes = scenes_for_ranks();
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    using fem_reference::Backend;
    fem_reference::Model shared(scenes[i], MPI_COMM_WORLD, Backend::grid),
        own(scenes[i], MPI_COMM_SELF, Backend::grid);
    const auto together = shared.solve(), alone = own.solve();
    CAPTURE(i, alone.newton_iterations, alone.linear_iterations, together.linear_iterations);
    // The same sums in the same order, but for quadratic elements: rounding, and what the path makes of it.
    const double scale = largest_entry(Eigen::Map<const Eigen::MatrixXd>(
        alone.displacement.front().data(), 3, static_cast<Eigen::Index>(alone.displacement.size())));
    CHECK(largest_difference(alone, together) <= 1e-9 * scale);
    CHECK(largest_volume_difference(alone, together) <= 1e-9); // mm³; cells are of the order 0.01 to 10 mm³
    CHECK(alone.unknowns == together.unknowns);
    CHECK(together.linear_iterations * 5 <= 6 * alone.linear_iterations);
    CHECK(alone.negative_eigenvalues == together.negative_eigenvalues);
    if (i + 1 == scenes.size()) CHECK(alone.negative_eigenvalues == 2);
    CHECK(shared.node_displacements().size() == own.node_displacements().size());
    // strains are differences of displacements that agree to 1e-9
    CHECK(largest_difference(own.fields(nullptr), shared.fields(together.sharing.get()),
                             part_of(alone, together)) <= 1e-6);
  }
}

TEST_CASE("every rank hears of a load that cannot be carried", "[.][ranks][grid_ranks]") {
  auto definition = small_block({10, 10, 10}, {8, 8, 8});
  definition.loads.front().kind = cases::loads::Traction{{0, 0, 1}};
  const auto scene = cases::make_scene(definition);
  CHECK_THROWS_AS(fem_reference::Model(scene, MPI_COMM_WORLD, fem_reference::Backend::grid).solve(),
                  cases::SolveError);
}

namespace {

/// Motions of bodies that are dealt out, of every kind of element, mass, damping, support, start and scheme;
/// and of one that is too small for it.
std::vector<cases::Scene> motions_for_ranks() {
  using cases::Element;
  std::vector<cases::Scene> scenes;
  cases::Case definition = scenes::block(cases::Formulation::log_strain, Element::q1_bbar);
  scenes.push_back(cases::make_scene(definition));
  const auto make = [&](const std::array<int, 3>& cells, cases::Formulation formulation, Element element,
                        cases::Scheme scheme) {
    definition = scenes::block(formulation, element);
    definition.body = cases::Box{Vector3d(8, 6, 12), cells};
    definition.dynamics->scheme.scheme = scheme;
    definition.dynamics->end = 0.02;
  };
  const auto add = [&] { scenes.push_back(cases::make_scene(definition)); };

  make({8, 7, 13}, cases::Formulation::hyperelastic, Element::q1_p0, cases::Scheme::newmark);
  definition.fem.mass = cases::ElementMass::lumped;
  add();
  make({9, 8, 12}, cases::Formulation::small_strain, Element::q1_bbar, cases::Scheme::bdf2);
  definition.material_dynamics = {1000., 5, 0.002};
  add();

  make({8, 7, 12}, cases::Formulation::log_strain, Element::q1, cases::Scheme::generalized_alpha);
  cases::RegionMaterial stiff;
  stiff.material = cases::LinearElastic{0.05, 0.2};
  stiff.dynamics = {2500., 0, 0.001};
  stiff.lower = Vector3d(3, -INFINITY, 8);
  stiff.upper = Vector3d(7, INFINITY, INFINITY);
  definition.region_materials = {stiff};
  definition.masses.push_back({scenes::region("z+"), 1e-4}); // kg; the block has 6e-4
  definition.dynamics->start = cases::MotionStart::equilibrium;
  definition.loads.front().history.points = {{0., 1.}, {0., 0.3}};
  add();

  for (const auto formulation : {cases::Formulation::small_strain, cases::Formulation::log_strain}) {
    make({8, 7, 13}, formulation, Element::q1_wilson, cases::Scheme::generalized_alpha);
    definition.material_dynamics = {1000., 5, 0.002};
    add();
  }

  make({8, 8, 11}, cases::Formulation::log_strain, Element::q1_bbar, cases::Scheme::implicit_euler);
  definition.fixed.clear();
  cases::Moved moved; // nodes of the first rank alone
  moved.region = scenes::region("z-");
  moved.displacement = Vector3d(2, 0.5, 0);
  moved.history.frequency = 10;
  definition.moved = {moved};
  add();
  return scenes;
}

} // namespace

TEST_CASE("a motion on a grid has the same digits on any number of ranks", "[.][ranks][grid_ranks]") {
  using fem_reference::Backend;
  const auto scenes = motions_for_ranks();
  const auto follow = [](const cases::Scene& scene, MPI_Comm communicator) {
    return fem_reference::follow(scene, fem_reference::default_steps(), Backend::grid, communicator);
  };
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    CAPTURE(i);
    const cases::Solution alone = follow(scenes[i], MPI_COMM_SELF),
                          together = follow(scenes[i], MPI_COMM_WORLD);
    const cases::Trajectory &one = *alone.trajectory, &all = *together.trajectory;
    REQUIRE(one.displacement.back().norm() > 0.1); // mm, of a block of 12
    CHECK(all.time == one.time);
    CHECK(all.displacement == one.displacement);
    CHECK(all.volume == one.volume);
    CHECK(all.largest_residual == one.largest_residual);
    REQUIRE(one.slowest);
    CHECK(all.slowest->omega == one.slowest->omega);
    CHECK(all.slowest->damping_ratio == one.slowest->damping_ratio);
    CHECK(all.bodies.back().displacement == one.bodies.back().displacement);
    CHECK(largest_difference(alone, together) == 0);
    CHECK(largest_volume_difference(alone, together) == 0);
    CHECK(together.newton_iterations == alone.newton_iterations);
    CHECK(together.linear_iterations == alone.linear_iterations);
    CHECK(together.unknowns == alone.unknowns);
  }
}

TEST_CASE("two ranks and one find the same motion by the assembled tangent", "[.][ranks]") {
  const auto element = GENERATE(cases::Element::q1_bbar, cases::Element::q2);
  cases::Case definition = scenes::block(cases::Formulation::log_strain, element);
  definition.material_dynamics = {1000., 5, 0.002};
  definition.dynamics->end = 0.012;
  const cases::Scene scene = cases::make_scene(definition);
  const auto follow = [&](MPI_Comm communicator) {
    return fem_reference::follow(scene, fem_reference::default_steps(), fem_reference::Backend::assembled,
                                 communicator);
  };
  const cases::Solution alone = follow(MPI_COMM_SELF), together = follow(MPI_COMM_WORLD);
  REQUIRE(alone.trajectory->displacement.back().norm() > 0.1); // mm
  CHECK(largest_difference(alone, together) <= 1e-8);          // mm: residuals are below 1e-10 of the forces
  CHECK(largest_volume_difference(alone, together) <= 1e-8);
  CHECK(together.trajectory->volume.back() == Approx(alone.trajectory->volume.back()).epsilon(1e-9));
  // known to about 1 %, from a start that depends on how degrees of freedom are numbered
  CHECK(together.trajectory->slowest->omega == Approx(alone.trajectory->slowest->omega).epsilon(0.02));
  CHECK(together.unknowns == alone.unknowns);
}
