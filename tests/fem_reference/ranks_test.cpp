#include "fem_reference/model.hpp"

#include "scenes.hpp"
#include "tests/support/largest.hpp"

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
                                 Combination{Formulation::hyperelastic, Element::q1_p0, 4},
                                 Combination{Formulation::hyperelastic, Element::q2_p1, 2});
  cases::Material material = scenes::thesis_elastic();
  if (c.formulation == Formulation::hyperelastic) material = scenes::thesis_ogden();
  const auto scene = cases::make_scene(scenes::cube(scenes::Test::torsion, scenes::LoadSet::small, material,
                                                    c.formulation, c.element, c.cells));
  fem_reference::Model shared(scene, MPI_COMM_WORLD), own(scene, MPI_COMM_SELF);
  const auto together = shared.solve(), alone = own.solve();
  // stiff pressures amplify 1e-10
  CHECK(largest_difference(own.fields(nullptr), shared.fields(together.sharing.get()),
                           part_of(alone, together)) <= 1e-8);
  CHECK(largest_difference(alone, together) <= 1e-10);        // mm, as asked; displacements are of order 1 mm
  CHECK(largest_volume_difference(alone, together) <= 1e-10); // mm³; cells are of the order 1 to 100 mm³
  CHECK(alone.unknowns == together.unknowns);
}

namespace {

cases::Case small_block(const Vector3d& size, const std::array<int, 3>& cells,
                        cases::Element element = cases::Element::q1_bbar) {
  auto definition = scenes::cube(scenes::Test::shear, scenes::LoadSet::small, scenes::thesis_elastic(),
                                 cases::Formulation::log_strain, element, 2);
  definition.body = cases::Box{size, cells};
  definition.loads = {{{"z+"}, cases::loads::Traction{Vector3d(0.006, 0.001, -0.002)}}};
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
