#include "cases/case/read_case.hpp"
#include "compare/provenance/machine.hpp"
#include "compare/solve/springs.hpp"
#include "tests/support/largest.hpp"
#include "tests/support/temporary_folder.hpp"

#include <catch2/catch.hpp>
#include <fmt/format.h>

using namespace springproof;

namespace {

/// The thesis's cube under its large shear, as a scene of other springs.
cases::Scene cube_of(const std::vector<std::string>& settings) {
  return cases::make_scene(
      cases::read_case(compare::cases_folder() + "/thesis/linear_elastic/cube_shear_large.toml", settings));
}

cases::Solution solved(const cases::Scene& scene) {
  std::optional<msm::DesignResult> design;
  return compare::solve_springs(scene, 1, design).solution;
}

/// The lines of a lattice's links.
std::string lines_of(const msm::Lattice& lattice) {
  std::string text = "a,b,stiffness_N_per_m\n";
  for (const msm::Link& link : lattice.links)
    text += fmt::format("{},{},{}\n", link.i, link.j, 1e3 * link.spring.stiffness);
  return text;
}

} // namespace

TEST_CASE("a network of the cube's own springs answers as the built-in lattice does", "[verification]") {
  const TemporaryFolder folder;
  const cases::Scene built_in = cube_of({});
  const msm::DesignResult design = compare::design_for(built_in);
  const std::string file =
      folder.write("springs.csv", lines_of(msm::make_lattice(built_in.mesh, design.springs)));
  cases::Scene network = built_in;
  network.definition.msm = {};
  network.definition.msm.design = cases::Design::network;
  network.definition.msm.network = cases::NamedFile{file};
  network = cases::make_scene(network.definition);
  REQUIRE(network.network.size() > 10000);
  const cases::Solution found = solved(network),
                        expected = msm::Model(built_in, design.springs, {msm::Path::direct}).solve();
  REQUIRE(expected.status == cases::Status::converged);
  REQUIRE(found.status == cases::Status::converged);
  double largest = 0;
  for (const Eigen::Vector3d& u : expected.displacement) largest = larger(largest, u.norm());
  CHECK(largest_difference(found, expected) <= 1e-9 * largest); // the same sums in another order
}
