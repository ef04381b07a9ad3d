// What GetFEM is told and answers, and (label peer, which needs python3-getfem) its answers to uniform
// strains.

#include "compare/peers/getfem.hpp"

#include "cases/case/read_case.hpp"
#include "compare/error_bars/auto_fem.hpp"
#include "compare/peers/peer_study.hpp"
#include "compare/table/array_message.hpp"

#include <catch2/catch.hpp>

using namespace springproof;
using namespace compare;
using Eigen::Vector3d;

namespace {

cases::Scene block(std::vector<std::string> settings) {
  settings.insert(settings.begin(),
                  {"body.cells=[2,1,1]", R"(measure=[{name="everywhere",kind="displacement_field_l2"}])"});
  return cases::make_scene(cases::read_case(
      std::string(SPRINGPROOF_SOURCE_DIR) + "/cases/studies/clamped_block_shear.toml", settings));
}

/// An answer on the case's own mesh, whose nodes all move alike.
std::string answer(const cases::Mesh& mesh, double x, std::size_t n_volumes) {
  ArrayMessage message;
  message.header = {{"reason", "as told"}, {"failed", false}};
  message.header["meshes"] = {{{"refine", 0},
                               {"unknowns", 7},
                               {"iterations", 2},
                               {"residual", 1e-12},
                               {"root_mean_square", 1.},
                               {"largest", 1.},
                               {"inverted", 0}}};
  NumberArray displacement{3}, volume{1, std::vector<double>(n_volumes, 5.)};
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n) displacement.add({x, 0, 0});
  message.add("displacement_0", displacement);
  message.add("volume_0", volume);
  return message.text();
}

} // namespace

TEST_CASE("a message of arrays is read as it was written") {
  ArrayMessage message;
  message.header["name"] = "any";
  message.add("a", {2, {1, 2, 3, 4}});
  message.add("none", {3, {}});
  const std::string text = message.text();
  const ReadMessage read = read_array_message(text);
  CHECK(read.header["name"] == "any");
  CHECK(read.arrays.at("a").values == std::vector<double>{1, 2, 3, 4});
  CHECK(read.arrays.at("none").values.empty());
  CHECK_THROWS_AS(read_array_message(text.substr(0, text.size() - 1)), std::runtime_error);
  CHECK_THROWS_AS(read_array_message(text + "x"), std::runtime_error);
  CHECK_THROWS_AS(read_array_message("{}"), std::runtime_error);
  CHECK_THROWS_AS(read_array_message(R"({"arrays": [{"name": "a", "shape": [9223372036854775807, 8]}]})"),
                  std::runtime_error);
}

TEST_CASE("GetFEM is told tractions and torques as linear functions of the point") {
  const cases::Scene scene = block({R"(load=[{region="z+",kind="traction",value=[1,2,3]},{region="z+",)"
                                    R"(kind="torque",value=2,axis=[0,0,1],centre=[5,5,10]}])"});
  const ReadMessage told = read_array_message(getfem_scene(scene));
  const Json &constant = told.header["loads"][0], &turning = told.header["loads"][1];
  CHECK(constant["constant"] == Json({1., 2., 3.}));
  CHECK(constant["gradient"][1] == Json({0., 0., 0.}));
  // 2 N mm over the polar moment of a square of 10 mm, 10^4/6 mm^4: the traction is axis x (x - centre) times
  // that
  const double slope = turning["gradient"][1][0];
  CHECK(slope == Approx(2 * 6 / 1e4));
  CHECK(turning["gradient"][0][1].get<double>() == Approx(-slope));
  CHECK(turning["constant"][0].get<double>() == Approx(5 * slope));
  CHECK(told.arrays.at("hexahedra").values.size() == 2 * 8);
  CHECK(told.header["law"] == "small_strain");
  CHECK(told.header["mixed"] == false);
  const auto near_incompressible = block({"material.poissons_ratio=0.45"});
  CHECK(read_array_message(getfem_scene(near_incompressible)).header["mixed"] == true);
}

TEST_CASE("what GetFEM has no words for is skipped, and the reason names it") {
  CHECK_FALSE(reason_without_getfem(block({})).has_value());
  const auto reason = [](const std::string& setting) {
    return reason_without_getfem(block({"material.density=1000", setting})).value_or("none");
  };
  CHECK_THAT(
      reason(R"(load=[{kind="gravity",value=[0,0,-1]},{region="z+",kind="nodal_force",value=[1,0,0]}])"),
      Catch::StartsWith("load[1]") && Catch::Contains("tractions"));
  CHECK_THAT(reason(R"(mass=[{region="z+",value=0.1}])"), Catch::Contains("[[mass]]"));
  CHECK_THAT(
      reason(R"(tool=[{name="lid",shape="plane",point=[0,0,10],normal=[0,0,-1],displacement=[0,0,-1]}])"),
      Catch::Contains("[[tool]] \"lid\""));
  CHECK_THAT(reason("dynamics={scheme=\"newmark\",step=0.01,end=0.02}"), Catch::Contains("[dynamics]"));
  cases::Scene fibrous = block({});
  fibrous.definition.material = cases::TransverselyIsotropic{0.3, 0.1, 0.4, 0.5, 0.05, Vector3d::UnitZ()};
  CHECK_THAT(*reason_without_getfem(fibrous), Catch::Contains("fibre"));
  const RefinedMeshes none = solve_with_getfem(fibrous);
  CHECK(none.solutions.empty());
  CHECK_THAT(none.reason, Catch::Contains("fibre"));
  cases::Scene joined = block({});
  joined.definition.removed = {{{0, 0, 0}, {5, 10, 10}, cases::Axis::x, {}}};
  CHECK_THAT(*reason_without_getfem(joined), Catch::Contains("[[body.removed]]"));
  cases::Scene fading = block({R"(moved=[{region="z+",components=["x"],displacement=[1,0,0]}])"});
  fading.moved.at(0).motion.scaled.emplace();
  CHECK_THAT(*reason_without_getfem(fading), Catch::StartsWith("moved[0]"));
}

TEST_CASE("an answer of GetFEM's is read, and refused when it is damaged") {
  const cases::Mesh mesh = block({}).mesh;
  const RefinedMeshes meshes = read_getfem_answer(answer(mesh, 0.5, 2), mesh);
  REQUIRE(meshes.solutions.size() == 1);
  CHECK(meshes.refine == std::vector<int>{0});
  CHECK(meshes.reason == "as told");
  CHECK(meshes.solutions[0].displacement.back() == Vector3d(0.5, 0, 0));
  CHECK(meshes.solutions[0].unknowns == 7);
  CHECK_THROWS_AS(read_getfem_answer(answer(mesh, NAN, 2), mesh), cases::SolveError);
  CHECK_THROWS_AS(read_getfem_answer(answer(mesh, 0.5, 3), mesh), cases::SolveError);
  CHECK_THROWS_AS(read_getfem_answer("", mesh), cases::SolveError);
  CHECK_THROWS_WITH(read_getfem_answer(R"({"reason": "it stops", "failed": true, "meshes": [], "arrays": []})"
                                       "\n",
                                       mesh),
                    "GetFEM: it stops");
}

TEST_CASE("two limits agree within the sum of their bars, and not beyond") {
  const PeerLimit near{"u", "mm", Limit{10, 0.1, ""}, Limit{10.25, 0.2, ""}, ""},
      far{"u", "mm", Limit{10, 0.1, ""}, Limit{10.35, 0.2, ""}, ""},
      none{"u", "mm", Limit{10, 0.1, ""}, {}, "why"};
  CHECK(near.is_within_bars() == true);
  CHECK(near.difference_percent().value() == Approx(2.5));
  CHECK(far.is_within_bars() == false);
  CHECK_FALSE(none.is_within_bars().has_value());
}

TEST_CASE("GetFEM's elements have the uniform strain of each law, with and without a pressure",
          "[peer][long]") {
  const std::string ogden = R"(material={model="ogden",mu=[0.06,0.04],alpha=[2.5,-2],bulk_modulus=)";
  const std::vector<std::vector<std::string>> laws{
      {"fem.formulation=small_strain"},
      {"fem.formulation=small_strain", "material.poissons_ratio=0.48"},
      {"fem.formulation=saint_venant_kirchhoff"},
      {"fem.formulation=log_strain"},
      {"fem.formulation=log_strain", "material.poissons_ratio=0.48"},
      {"fem.formulation=hyperelastic", ogden + "0.2}"},
      {"fem.formulation=hyperelastic", ogden + "3}"},
      {"fem.formulation=hyperelastic",
       R"(material={model="yeoh",c10=0.05,c20=-0.01,c30=0.02,bulk_modulus=3})"}};
  for (std::vector<std::string> settings : laws) {
    // held on three planes, pulled sideways alike and stretched along z, it is a cuboid
    settings.insert(settings.end(),
                    {R"(fixed=[{region="x-",components=["x"]},{region="y-",components=["y"]},)"
                     R"({region="z-",components=["z"]}])",
                     R"(load=[{region="x+",kind="traction",value=[1e-3,0,0]},)"
                     R"({region="y+",kind="traction",value=[0,1e-3,0]}])",
                     R"(moved=[{region="z+",components=["z"],displacement=[0,0,1]}])"});
    const cases::Scene scene = block(settings);
    const RefinedMeshes meshes = solve_with_getfem(scene, 2);
    if (meshes.solutions.empty()) {
      FAIL("nothing was compared: " + meshes.reason);
    }
    INFO(settings[0] << " " << settings[1]);
    // So have ours, whose laws have closed forms of their own: one mesh tells all.
    const Vector3d ours = solve_fem(scene, 0).fem.solution.displacement.back() / 10;
    for (const cases::Solution& solution : meshes.solutions) {
      const Vector3d stretch = solution.displacement.back() / 10;
      CHECK(stretch.z() == Approx(0.1));
      CHECK(stretch.x() < 0);
      CHECK(stretch.x() == Approx(ours.x()).epsilon(1e-5));
      CHECK(stretch.x() == Approx(stretch.y()).epsilon(1e-5)); // a residual of 1e-7 of the loads
      for (std::size_t n = 0; n < scene.mesh.nodes.size(); ++n)
        CHECK((solution.displacement[n] - stretch.cwiseProduct(scene.mesh.nodes[n])).norm() <= 1e-5);
    }
  }
}

TEST_CASE("GetFEM's pressure jumps between two layers that keep their volume, by either law",
          "[peer][long]") {
  // Between smooth walls all around, the layers lie in a row: each has the load's stress, and its own
  // pressure.
  const auto layers = [](const std::string& formulation) {
    return block({"body.cells=[1,1,2]", "fem.formulation=" + formulation, "material.youngs_modulus=0.3",
                  "material.poissons_ratio=0.49",
                  R"(region_material=[{model="linear_elastic",axis="z",from=5,youngs_modulus=0.6,)"
                  R"(poissons_ratio=0.45}])",
                  R"(fixed=[{region="x-",components=["x"]},{region="y-",components=["y"]},)"
                  R"({region="x+",components=["x"]},{region="y+",components=["y"]},)"
                  R"({region="z-",components=["z"]}])",
                  R"(load=[{region="z+",kind="traction",value=[0,0,0.3]}])",
                  R"(measure=[{name="everywhere",kind="displacement_field_l2"}])"});
  };
  const auto modulus = [](double youngs, double ratio) { // a pull's between the walls
    return youngs * (1 - ratio) / ((1 + ratio) * (1 - 2 * ratio));
  };
  for (const std::string formulation : {"small_strain", "log_strain"}) {
    const cases::Scene scene = layers(formulation);
    const double strain[2] = {0.3 / modulus(0.3, 0.49), 0.3 / modulus(0.6, 0.45)};
    const RefinedMeshes meshes = solve_with_getfem(scene, 2);
    if (meshes.solutions.empty()) {
      FAIL("nothing was compared: " + meshes.reason);
    }
    INFO(formulation);
    for (const cases::Solution& solution : meshes.solutions)
      for (std::size_t n = 0; n < scene.mesh.nodes.size(); ++n) {
        const double z = scene.mesh.nodes[n].z();
        double rise = 0;
        for (int layer = 0; layer < 2; ++layer)
          if (z > 5 * layer)
            rise += 5 * (formulation == "log_strain" ? std::expm1(strain[layer]) : strain[layer]);
        CHECK((solution.displacement[n] - Vector3d(0, 0, rise)).norm() <= 1e-5);
      }
  }
}
