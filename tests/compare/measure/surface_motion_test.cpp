#include "compare/measure/surfaces.hpp"

#include "compare/write/write.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

using namespace springproof;

using Eigen::Vector3d;

namespace {

/// A bar of four cells along x, 8 mm long, whose outer surface is its skin.
cases::Scene bar_with_skin() {
  cases::Case definition;
  definition.body = cases::Box{{8, 2, 2}, {4, 1, 1}};
  cases::Scene scene = cases::make_scene(definition);
  scene.definition.surface.emplace();
  scene.definition.dynamics.emplace();
  scene.surface = cases::outer_surface(scene.mesh);
  return scene;
}

/// At rest, and after a second all by the same way.
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
  CHECK(compare::surface_motion(scene, answers)->error_percent.value() == Approx(300)); // of a body at rest
  cases::Trajectory& fem = *answers.fem.solution.trajectory;
  fem.nodes = {0};
  fem.displacement = {{0, 0, 0}, {0, 0, 1}}; // between the bodies that are kept
  CHECK_FALSE(compare::surface_motion(scene, answers)->error_percent);
}

TEST_CASE("what is written of surfaces in motion is what the comparison has found of them") {
  cases::Scene scene = bar_with_skin();
  compare::Answers answers;
  answers.fem = pushed(scene, {0, 0, 2});
  answers.msm = pushed(scene, {0, 0.2, 2});
  compare::Comparison comparison = compare::comparison_of(std::move(scene), std::move(answers));
  REQUIRE(comparison.surface_motion);
  comparison.surface_motion->error_percent = 42; // as nothing would find it anew
  CHECK(compare::motion_to_json(comparison)["surface"]["error_percent"] == 42);
  const std::vector<std::string> notes = compare::notes_on_motion(comparison);
  REQUIRE(notes.size() == 1);
  CHECK_THAT(notes.front(), Catch::Contains("42 %"));
}
