#include "fem_reference/model.hpp"

#include "scenes.hpp"
#include "tests/support/largest.hpp"

#include <catch2/catch.hpp>

using namespace springproof;

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
  const auto together = fem_reference::Model(scene, MPI_COMM_WORLD).solve();
  const auto alone = fem_reference::Model(scene, MPI_COMM_SELF).solve();
  CHECK(largest_difference(alone, together) <= 1e-10);        // mm, as asked; displacements are of order 1 mm
  CHECK(largest_volume_difference(alone, together) <= 1e-10); // mm³; cells are of the order 1 to 100 mm³
  CHECK(alone.unknowns == together.unknowns);
}
