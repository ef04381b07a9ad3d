#include "compare/study/on_mesh.hpp"

#include "cases/case/error.hpp"
#include "tests/support/bodies.hpp"
#include "tests/support/tetrahedra.hpp"

#include <catch2/catch.hpp>
#include <set>
#include <sstream>
#include <utility>

using namespace springproof;

namespace {

cases::Scene box_scene(int n_cells, cases::Design design) {
  cases::Case definition = bodies::clamped_box({n_cells, n_cells, n_cells}, {});
  definition.msm.design = design;
  return cases::make_scene(definition);
}

/// The same body in tetrahedra.
cases::Scene tetrahedra_scene() {
  cases::Scene scene = box_scene(3, cases::Design::hybrid);
  scene.mesh = bodies::box_of_tetrahedra({3, 3, 3});
  return scene;
}

std::string text_of(const compare::SpringsOnMesh& study) {
  std::ostringstream out;
  compare::write_on_mesh_text(out, study);
  return out.str();
}

} // namespace

TEST_CASE("on a grid the hybrid has the material's moduli, relaxed too, and no zero mode", "[verification]") {
  const auto study = compare::study_on_mesh(box_scene(3, cases::Design::hybrid), {});
  const compare::MaterialOnMesh& found = study.designs.at(0).materials.at(0);
  CHECK(found.n_inner == 8);
  REQUIRE(found.relaxed);
  for (const msm::LatticeModuli& moduli : {found.uniform, *found.relaxed, *found.wanted}) {
    CHECK(moduli.youngs_modulus == Approx(0.3).epsilon(1e-9)); // closed forms
    CHECK(moduli.poissons_ratio == Approx(0.35).epsilon(1e-9));
    CHECK(moduli.shear_modulus == Approx(0.3 / 2.7).epsilon(1e-9));
  }
  CHECK(*found.worst_misfit < 1e-9);
  CHECK(study.designs[0].motions->n == 0);
}

TEST_CASE("a cube of edges has six zero modes: 24 degrees of freedom, 12 springs, 6 rigid motions",
          "[verification]") {
  cases::Scene scene = box_scene(1, cases::Design::given);
  scene.definition.msm.stiffness = std::array<double, 3>{10, 0, 0};
  const auto study = compare::study_on_mesh(scene, {});
  CHECK(study.designs.at(0).motions->n == 6);
  CHECK_FALSE(study.designs[0].motions->are_more);
  CHECK(study.designs[0].motions->nodes.size() == 8);
  CHECK(study.designs[0].materials[0].not_relaxed == "no node lies inside");
  scene = box_scene(4, cases::Design::given);
  scene.definition.msm.stiffness = std::array<double, 3>{10, 0, 0};
  const auto large = compare::study_on_mesh(scene, {}).designs.at(0);
  CHECK(large.motions->n == 20); // as many as are looked for
  CHECK(large.motions->are_more);
}

TEST_CASE("a node of a network that hangs on one spring is named") {
  cases::Scene scene = tetrahedra_scene();
  scene.definition.msm.design = cases::Design::network;
  std::set<std::array<int, 2>> pairs;
  for (const cases::CellNodes& cell : scene.mesh.cells)
    for (const int a : cell)
      for (const int b : cell)
        if (a < b && a != 5) pairs.insert({a, b}); // node 5 is the second of its pairs, or none
  bool hangs = false;
  for (const auto& [a, b] : pairs)
    if (b != 5 || !std::exchange(hangs, true)) scene.network.push_back({a, b, 0.1, 7.});
  REQUIRE(hangs);
  const auto design = compare::study_on_mesh(scene, {}).designs.at(0);
  CHECK(design.motions->n == 2); // rest lengths do not count
  CHECK(design.motions->nodes == std::vector{5});
  CHECK_FALSE(design.materials.at(0).worst_misfit);
}

TEST_CASE("designs for hexahedra are rows with their reason; the case's own refusal is thrown") {
  cases::Scene scene = tetrahedra_scene();
  const auto study = compare::study_on_mesh(
      scene, {cases::Design::hybrid, cases::Design::linear_method, cases::Design::biquadratic});
  CHECK(study.designs.at(0).refusal.empty());
  CHECK_THAT(study.designs.at(1).refusal, Catch::Contains("the others are for hexahedra"));
  const compare::MaterialOnMesh& exact = study.designs.at(2).materials.at(0);
  CHECK(exact.relaxed->shear_modulus == Approx(exact.wanted->shear_modulus).epsilon(1e-9));
  CHECK_THAT(text_of(study), Catch::Contains("162 tetrahedra, 64 nodes") &&
                                 Catch::Contains("linear_method    refused: ") &&
                                 Catch::Contains("warning: hybrid: springs cannot follow the shapes"));
  scene.definition.msm.design = cases::Design::linear_method;
  CHECK_THROWS_AS(compare::study_on_mesh(scene, {}), cases::InputError);
}

TEST_CASE("each material of a mesh has its own moduli, and its own nodes inside") {
  cases::Scene scene = box_scene(4, cases::Design::hybrid);
  cases::RegionMaterial top;
  top.material = cases::LinearElastic{3, 0.2};
  scene.definition.region_materials = {top};
  for (std::size_t c = 0; c < scene.mesh.cells.size(); ++c)
    scene.material_of_cell.push_back(cases::centre_of(scene.mesh, scene.mesh.cells[c]).z() > 2);
  const auto study = compare::study_on_mesh(scene, {});
  const auto& [soft, stiff] = std::tie(study.designs.at(0).materials.at(0), study.designs[0].materials.at(1));
  CHECK(soft.n_inner == 9);
  CHECK(stiff.n_inner == 9);
  CHECK(soft.relaxed->youngs_modulus == Approx(0.3).epsilon(1e-9));
  CHECK(stiff.relaxed->youngs_modulus == Approx(3).epsilon(1e-9));
  CHECK_THAT(text_of(study), Catch::Contains("material 2 of 2: 32 cells, 9 nodes inside"));
}
