#include "compare/peers/external_side.hpp"

#include "cases/case/error.hpp"
#include "cases/case/read_case.hpp"
#include "compare/gates/comparison.hpp"
#include "compare/write/write.hpp"
#include "tests/support/largest.hpp"
#include "tests/support/unwrapped.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <sstream>

using namespace springproof;

using compare::GivenDisplacement;
using compare::match_nodes;
using compare::Transfer;

namespace {

const std::string external_cases = SPRINGPROOF_SOURCE_DIR "/cases/external/";

/// A node per vertex of the mesh, in another order, moved by its own position.
std::vector<GivenDisplacement> given_for(const cases::HexMesh& mesh) {
  std::vector<GivenDisplacement> given;
  for (const Eigen::Vector3d& x : mesh.nodes)
    given.push_back({x, x, "a.csv:" + std::to_string(given.size() + 2)});
  std::reverse(given.begin(), given.end());
  return given;
}

} // namespace

TEST_CASE("given nodes are found by their place, within a millionth of the body's size and no further") {
  const cases::HexMesh mesh = cases::make_box_mesh({2, 2, 2}, {2, 2, 2});
  auto given = given_for(mesh);
  CHECK(match_nodes(mesh, given, "a.csv") == mesh.nodes.to_vector());
  for (GivenDisplacement& node : given) node.position += Eigen::Vector3d(-5e-7, 5e-7, -5e-7);
  CHECK(match_nodes(mesh, given, "a.csv") == mesh.nodes.to_vector());
  given[3].position.x() += 5e-6; // the diagonal is 3.5 mm
  CHECK_THROWS_WITH(match_nodes(mesh, given, "a.csv"), Catch::StartsWith(given[3].where + ": ") &&
                                                           Catch::Contains("no node") &&
                                                           Catch::Contains("nearest"));
}

TEST_CASE("every node is given once: one twice, one missing and one too many are refused") {
  const cases::HexMesh mesh = cases::make_box_mesh({2, 2, 2}, {1, 1, 1});
  auto twice = given_for(mesh);
  twice.push_back(twice.front());
  CHECK_THROWS_WITH(match_nodes(mesh, twice, "a.csv"),
                    Catch::Contains("given twice, first in " + twice[0].where));
  auto missing = given_for(mesh);
  missing.pop_back();
  CHECK_THROWS_WITH(match_nodes(mesh, missing, "a.csv"),
                    Catch::Contains("has 7 of the 8 nodes") && Catch::Contains("(0, 0, 0) is missing"));
  CHECK_THROWS_AS(match_nodes(mesh, {}, "a.csv"), cases::InputError);
}

TEST_CASE("an independent program's springs are measured with our ruler and agree with ours", "[peer]") {
  const cases::Case definition = cases::read_case(external_cases + "pulled_bar.toml");
  const compare::Comparison by_us = compare::compare_case(definition);
  CHECK(by_us.met());
  const auto& ours = by_us.answers.msm.solution;
  const auto external = compare::read_external({{cases::make_scene(definition), {}}},
                                               external_cases + "pulled_bar.csv", Transfer::matched);
  REQUIRE(external);
  const compare::Comparison by_them =
      compare::comparison_of(by_us.scene, compare::with_displacements(by_us.answers, by_us.scene, *external));
  const auto& theirs = by_them.answers.msm.solution;
  CHECK(largest_difference(ours, theirs) <= 1e-8); // ours ends at 1e-9 of the load; 0.5 mm at the free end
  CHECK(largest_volume_difference(ours, theirs) <= 1e-8); // of 1 mm³
  CHECK(by_them.met());
}

TEST_CASE("the report of another program's springs says where they come from, without stiffness and counts") {
  const cases::Case definition = cases::read_case(external_cases + "pulled_bar.toml");
  const compare::Comparison ours = compare::compare_case(definition);
  const auto external = compare::read_external({{cases::make_scene(definition), {}}},
                                               external_cases + "pulled_bar.csv", Transfer::matched);
  const compare::Comparison comparison =
      compare::comparison_of(ours.scene, compare::with_displacements(ours.answers, ours.scene, *external));
  const auto side = nlohmann::json::parse(compare::to_json({comparison}).dump())["cases"][0]["msm"];
  CHECK(side["status"] == "converged");
  CHECK(side["source"] == external_cases + "pulled_bar.csv");
  CHECK_FALSE(side.contains("stiffness_N_per_m"));
  CHECK(side["newton_iterations"].is_null());
  CHECK(side["residual"].is_null());
  CHECK(side["inverted_cells"] == 0);
  std::ostringstream text;
  compare::write_text(text, comparison);
  CHECK_THAT(unwrapped(text.str()),
             Catch::Contains(" springs  displacements of " + external_cases + "pulled_bar.csv at 45 nodes "));
  CHECK(text.str().find("given with") == std::string::npos);
}

TEST_CASE("one file of displacements belongs to one case") {
  const cases::Case definition = cases::read_case(external_cases + "pulled_bar.toml");
  CHECK_THROWS_AS(
      compare::read_external({{cases::make_scene(definition), {}}, {cases::make_scene(definition), {}}},
                             external_cases + "pulled_bar.csv", Transfer::matched),
      cases::InputError);
  CHECK_FALSE(compare::read_external({{cases::make_scene(definition), {}}}, "", Transfer::matched));
}
