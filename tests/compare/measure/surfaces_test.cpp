#include "compare/measure/surfaces.hpp"

#include "cases/case/read_case.hpp"
#include "compare/gates/comparison.hpp"
#include "compare/write/write.hpp"
#include "tests/support/case_text.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

using namespace springproof;

using namespace compare;
using Eigen::Vector3d;

namespace {

const std::string block_text = R"(schema = 1
name = "block"
[body]
shape = "box"
size = [4, 4, 2]
cells = [4, 4, 2]
[material]
model = "linear_elastic"
youngs_modulus = 0.3
poissons_ratio = 0.3
[[fixed]]
region = "z-"
[[load]]
region = "z+"
kind = "traction"
value = [0, 0, 0.001]
[fem]
accuracy = "none"
[[measure]]
name = "top"
kind = "displacement"
node = "z+ x+ y+"
component = "z"
[[landmark]]
name = "top"
point = [2.1, 1.9, 2]
[[landmark]]
name = "side"
point = [4, 2.2, 1.1]
)";

Answer answer_of(const cases::Scene& scene, const std::function<Vector3d(const Vector3d&)>& displacement) {
  Answer answer;
  answer.solution.status = cases::Status::converged;
  for (const Vector3d& node : scene.mesh.nodes) answer.solution.displacement.push_back(displacement(node));
  return answer;
}

} // namespace

TEST_CASE("landmarks have the distance of two flat surfaces along their normal", "[verification]") {
  const cases::Scene scene = cases::make_scene(cases::read_case_text(block_text, "block.toml"));
  Answers answers;
  // Both faces stay planes: the top ends at 2.2 and 2.3 mm, the side at 3.6 and 3.56 mm.
  answers.fem = answer_of(scene, [](const Vector3d& x) { return Vector3d(-0.1 * x.x(), 0, 0.1 * x.z()); });
  answers.msm = answer_of(scene, [](const Vector3d& x) { return Vector3d(-0.11 * x.x(), 0, 0.15 * x.z()); });
  const auto found = landmark_distances(scene, answers);
  REQUIRE(found.size() == 2);
  CHECK(found[0].name == "top");
  CHECK(found[0].to_fem.n_rays == 5);
  CHECK(found[0].to_fem.mean.value() == Approx(0.1).epsilon(1e-12));
  CHECK(found[0].to_fem.deviation.value() == Approx(0).margin(1e-13));
  CHECK(found[0].from_point.value() < 0.5); // triangles of half a square of 1 mm
  CHECK(found[1].to_fem.mean.value() == Approx(0.04).epsilon(1e-12));
}

TEST_CASE("landmarks on a tilted surface have the mean and deviation of their rays", "[verification]") {
  const cases::Scene scene = cases::make_scene(cases::read_case_text(block_text, "block.toml"));
  Answers answers;
  // The springs stay at rest; the finite elements' top rises by 0.05 x: the ray at x has that length.
  answers.fem = answer_of(scene, [](const Vector3d& x) { return Vector3d(0, 0, 0.025 * x.x() * x.z()); });
  answers.msm = answer_of(scene, [](const Vector3d&) { return Vector3d(0, 0, 0); });
  const LandmarkDistance top = landmark_distances(scene, answers)[0];
  // Barycentres at thirds of the squares around (2.1, 1.9), by their diagonals x = y.
  const cases::TriangleMesh outer = cases::triangles_of_faces(scene.mesh, cases::boundary_faces(scene.mesh));
  std::vector<std::pair<double, double>> lengths; // distance from the point, length of the ray
  for (const auto& triangle : outer.triangles) {
    const Vector3d at = cases::barycentre(triangle, outer.vertices);
    if (at.z() > 1.999) lengths.emplace_back((at - Vector3d(2.1, 1.9, 2)).norm(), 0.05 * at.x());
  }
  std::sort(lengths.begin(), lengths.end());
  double sum = 0, squares = 0;
  for (std::size_t i = 0; i < 5; ++i)
    sum += lengths[i].second, squares += lengths[i].second * lengths[i].second;
  CHECK(top.to_fem.mean.value() == Approx(sum / 5).epsilon(1e-12));
  CHECK(top.to_fem.deviation.value() == Approx(std::sqrt((squares - sum * sum / 5) / 4)).epsilon(1e-9));
  CHECK(top.moved.value() == Approx(sum / 5).epsilon(1e-12));
}

TEST_CASE("landmarks of an answer out of equilibrium have the distance from their own equilibrium too") {
  cases::Case definition = cases::read_case_text(block_text, "block.toml");
  definition.msm.solver = cases::Solver::force_scaling;
  definition.msm.relaxation = cases::RelaxationCounts{2, 3, 10};
  Request springs_alone;
  springs_alone.only = cases::Side::msm;
  const Comparison found = compare_case(definition, springs_alone);
  const cases::Solution& few = found.answers.msm.solution;
  REQUIRE(few.from_equilibrium);
  // The top keeps nearly level: the rays have the vertical distance of the masses' mean.
  double lowest = 1e9, highest = 0;
  for (std::size_t n = 0; n < few.displacement.size(); ++n)
    if (found.scene.mesh.nodes[n].z() > 1.999) {
      const double apart = std::abs(few.displacement[n].z() - few.from_equilibrium->displacement[n].z());
      lowest = std::min(lowest, apart), highest = std::max(highest, apart);
    }
  const LandmarkDistance& top = found.landmarks[0];
  REQUIRE(top.to_equilibrium);
  CHECK(top.to_equilibrium->n_rays == 5);
  CHECK(top.to_equilibrium->mean.value() >= 0.99 * lowest);
  CHECK(top.to_equilibrium->mean.value() <= 1.01 * highest);
  CHECK(lowest > 0);
  CHECK_FALSE(top.to_fem.mean);
  CHECK_THAT(top.missing, Catch::Contains("both models"));
  std::ostringstream text, csv;
  write_landmarks_text(text, found);
  write_landmarks_csv(csv, found);
  CHECK_THAT(text.str(), Catch::Contains("to their equilibrium"));
  CHECK_THAT(csv.str(), Catch::Contains("to_equilibrium_mean,to_equilibrium_deviation"));
  const auto json = landmarks_to_json(found);
  CHECK(json[0]["to_equilibrium"]["mean"].get<double>() == top.to_equilibrium->mean.value());
  CHECK(json[0]["mean"].is_null());
}

TEST_CASE(
    "landmarks of a case are in text, JSON and CSV, and without a solution they say why there is none") {
  const Comparison solved = compare_case(cases::read_case_text(block_text, "block.toml"));
  std::ostringstream text, csv;
  write_landmarks_text(text, solved);
  write_landmarks_csv(csv, solved);
  CHECK_THAT(text.str(), Catch::Contains("landmark, mm") && Catch::Contains("side"));
  const std::string rows = csv.str();
  CHECK(std::count(rows.begin(), rows.end(), '\n') == 3);
  const auto json = landmarks_to_json(solved);
  REQUIRE(json.size() == 2);
  CHECK(json[0]["n_rays"] == 5);
  CHECK(json[0]["mean"].get<double>() > 0);
  CHECK(json[0]["mean"].get<double>() < json[0]["moved"].get<double>());
  CHECK(json[0]["to_equilibrium"].is_null());

  Request springs_alone;
  springs_alone.only = cases::Side::msm;
  const Comparison half = compare_case(cases::read_case_text(block_text, "block.toml"), springs_alone);
  REQUIRE(half.landmarks.size() == 2);
  CHECK_FALSE(half.landmarks[0].to_fem.mean);
  CHECK_FALSE(half.landmarks[0].from_point);
  CHECK_THAT(half.landmarks[0].missing, Catch::Contains("both models"));
}

TEST_CASE("a case's surface file is read, bound and measured, and a broken one is refused at its place") {
  const TemporaryFolder folder;
  const std::string with_surface = block_text + "[surface]\nfile = \"top.stl\"\n";
  const std::string triangles =
      "solid top\n"
      "facet normal 0 0 1\nouter loop\nvertex 0 0 2.2\nvertex 4 0 2.2\nvertex 0 4 2.2\n"
      "endloop\nendfacet\nendsolid\n";
  folder.write("top.stl", triangles);
  const std::string file = folder.write("case.toml", with_surface);
  const cases::Scene scene = cases::make_scene(cases::read_case(file));
  REQUIRE(scene.surface.triangles.size() == 1);
  const auto embedded = embedded_surface(scene);
  CHECK(embedded.n_outside == 3);
  CHECK(embedded.largest_distance == Approx(0.2).epsilon(1e-5)); // single precision
  folder.write("top.stl", "solid nothing\nendsolid\n");
  CHECK_THROWS_WITH(cases::make_scene(cases::read_case(file)),
                    Catch::Contains("case.toml:") && Catch::Contains("no triangles"));
  CHECK_THROWS_WITH(
      cases::read_case_text(block_text + "[[landmark]]\nname = \"top\"\npoint = [0, 0, 0]\n", "a.toml"),
      Catch::Contains("another landmark has this one"));
}

namespace {

/// A bar of four cells along x, 8 mm long, whose outer surface is its skin.
cases::Scene bar_with_skin() {
  cases::Case definition;
  definition.body = cases::Box{{8, 2, 2}, {4, 1, 1}};
  cases::Scene scene = cases::make_scene(definition);
  scene.definition.surface.emplace();
  scene.definition.dynamics.emplace();
  scene.surface = cases::triangles_of_faces(scene.mesh, cases::boundary_faces(scene.mesh));
  return scene;
}

/// An answer that is at rest at 0 s, and has moved all nodes by `way` at 1 s.
compare::Answer pushed(const cases::Scene& scene, const Vector3d& way) {
  compare::Answer answer;
  answer.solution.status = cases::Status::converged;
  answer.solution.displacement.assign(scene.mesh.nodes.size(), way);
  cases::Trajectory& motion = answer.solution.trajectory.emplace();
  motion.time = {0, 1};
  motion.bodies.push_back({0, std::vector<Vector3d>(scene.mesh.nodes.size(), Vector3d::Zero())});
  motion.bodies.push_back({1, answer.solution.displacement});
  return answer;
}

} // namespace

TEST_CASE("the distance of two moving surfaces is that of the motions they follow") {
  const cases::Scene scene = bar_with_skin();
  compare::Answers answers;
  answers.fem = pushed(scene, {0, 0, 2});
  answers.msm = pushed(scene, {0, 0.2, 2});
  const auto motion = compare::surface_motion(scene, answers);
  REQUIRE(motion);
  CHECK(motion->time == std::vector<double>{0, 1});
  CHECK(motion->fem[1] == Approx(2).epsilon(1e-14));
  CHECK(motion->difference[1] == Approx(0.2).epsilon(1e-14));
  CHECK(motion->largest[1] == Approx(0.2).epsilon(1e-14));
  CHECK(motion->error_percent.value() == Approx(10).epsilon(1e-12)); // rounding of sums
}

TEST_CASE("the largest distance of two surfaces is not a number if that of a vertex is none") {
  const cases::Scene scene = bar_with_skin();
  compare::Answers answers;
  answers.fem = answers.msm = pushed(scene, {0, 0, 2});
  std::size_t first =
      0; // the node of the first vertex: its cell's vertices are no numbers, the others follow
  while ((scene.mesh.nodes[first] - scene.surface.vertices.front()).norm() > 1e-9) ++first;
  answers.msm.solution.trajectory->bodies[1].displacement[first].x() =
      std::numeric_limits<double>::quiet_NaN();
  const auto motion = compare::surface_motion(scene, answers);
  REQUIRE(motion);
  CHECK(std::isnan(motion->largest[1]));
  CHECK_FALSE(motion->error_percent);
}

TEST_CASE("a surface that rests but for rounding while the body moves has no error in percent") {
  const cases::Scene scene = bar_with_skin();
  compare::Answers answers;
  answers.fem = pushed(scene, {0, 0, 1e-12});
  answers.msm = pushed(scene, {0, 0, -2e-12});
  CHECK(compare::surface_motion(scene, answers)->error_percent.value() == Approx(300)); // the body rests too
  cases::Trajectory& fem = *answers.fem.solution.trajectory;
  fem.nodes = {0};
  fem.displacement = {{0, 0, 0}, {0, 0, 1}}; // it moves between the bodies that are kept
  CHECK_FALSE(compare::surface_motion(scene, answers)->error_percent);
}

TEST_CASE("what is written of surfaces in motion is what the comparison has found of them") {
  cases::Scene scene = bar_with_skin();
  compare::Answers answers;
  answers.fem = pushed(scene, {0, 0, 2});
  answers.msm = pushed(scene, {0, 0.2, 2});
  compare::Comparison comparison = compare::comparison_of(std::move(scene), std::move(answers));
  REQUIRE(comparison.surface_motion);
  comparison.surface_motion->error_percent = 42; // a number that no computation would give
  CHECK(compare::motion_to_json(comparison)["surface"]["error_percent"] == 42);
  const std::vector<std::string> notes = compare::notes_on_motion(comparison);
  REQUIRE(notes.size() == 1);
  CHECK_THAT(notes.front(), Catch::Contains("42 %"));
}
