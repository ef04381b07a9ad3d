#include "compare/report/pages.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

using namespace springproof;

using compare::views_to_json;
using Points = std::vector<Eigen::Vector3d>;

namespace {

Points moved(const cases::Mesh& mesh, const Eigen::Vector3d& by) {
  return Points(mesh.nodes.size(), by);
}

} // namespace

TEST_CASE("a view has the body's surface alone, and whole numbers of units that leave five digits") {
  const cases::Mesh mesh = cases::make_box_mesh({2, 2, 2}, {{2, 2, 2}}); // 27 nodes, one of them inside
  const Points fem = moved(mesh, {0.25, 0, -0.000004}), springs = moved(mesh, {0, 0.5, 0.000006});
  const auto json = views_to_json({{"cube", {"", {&mesh, &fem}, {&mesh, &springs}}}});
  REQUIRE(json["bodies"].size() == 1);                 // both sides share it
  CHECK(json["bodies"][0]["unit_mm"] == Approx(1e-4)); // the body reaches to 2 mm
  CHECK(json["bodies"][0]["rest"].size() == 3 * 26);
  CHECK(json["bodies"][0]["faces"].size() == 4 * 24);
  for (const auto& node : json["bodies"][0]["faces"]) CHECK(node.get<int>() < 26);
  const auto& view = json["views"][0];
  CHECK(view["id"] == "cube");
  REQUIRE(view["fem"]["displacement"].size() == 3 * 26);
  CHECK(view["fem"]["unit_mm"] == Approx(1e-5));
  CHECK(view["fem"]["displacement"][75] == 25000);
  CHECK(view["fem"]["displacement"][77] == 0); // -0.4 units
  CHECK(view["springs"]["displacement"][76] == 50000);
  CHECK(view["springs"]["displacement"][77] == 1); // 0.6 units
}

TEST_CASE("bodies of unlike meshes are told apart in one view") {
  const cases::Mesh coarse = cases::make_box_mesh({1, 1, 4}, {{1, 1, 4}});
  const cases::Mesh fine = cases::make_box_mesh({1, 1, 4}, {{2, 2, 8}});
  const Points on_fine = moved(fine, {1, 0, 0}), on_coarse = moved(coarse, {1, 0, 0});
  const auto json = views_to_json({{"bar", {"", {&fine, &on_fine}, {&coarse, &on_coarse}}}});
  REQUIRE(json["bodies"].size() == 2);
  CHECK(json["views"][0]["fem"]["body"] != json["views"][0]["springs"]["body"]);
}

TEST_CASE("a side that has no equilibrium is left out of its view") {
  const cases::Mesh mesh = cases::make_box_mesh({1, 1, 1}, {{1, 1, 1}});
  const Points fem = moved(mesh, {0.1, 0, 0}), none;
  const auto json = views_to_json({{"cube", {"", {&mesh, &fem}, {&mesh, &none}}}});
  CHECK(json["views"][0].contains("fem"));
  CHECK_FALSE(json["views"][0].contains("springs"));
}

TEST_CASE("small displacements may be drawn up to a hundredfold, large ones twofold") {
  const cases::Mesh mesh = cases::make_box_mesh({10, 10, 10}, {{1, 1, 1}});
  const auto [displacement, scale] =
      GENERATE(table<double, double>({{0.0, 2}, {0.001, 100}, {0.1, 50}, {1.0, 5}, {20.0, 2}}));
  const Points both = moved(mesh, {displacement, 0, 0});
  CHECK(views_to_json({{"cube", {"", {&mesh, &both}, {&mesh, &both}}}})["views"][0]["largest_scale"] ==
        scale);
}
