#include "msm/model.hpp"

#include "cases/error.hpp"
#include "tests/msm/bodies.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using Eigen::Vector3d;

namespace {

const double degrees = 180 / std::acos(-1.0);

struct Cube {
  cases::Scene scene;
  cases::Solution solution;
  Cube(std::vector<cases::Load> loads, const msm::CellStiffness& stiffness)
      : scene(cases::make_scene(bodies::clamped_box({10, 10, 10}, std::move(loads)))),
        solution(msm::Model(scene, {stiffness}).solve()) {}
  Vector3d at(double x, double y, double z) const {
    cases::Region node;
    node.near = Vector3d(x, y, z);
    const auto n = static_cast<std::size_t>(cases::select_node(scene.mesh, node));
    return scene.mesh.nodes[n] + solution.displacement[n];
  }
  double tilt(double x) const {
    const Vector3d up = at(x, 0, 10) - at(x, 0, 0);
    return degrees * std::atan2(up.x(), up.z());
  }
  double twist(double x, double y) const {
    const Vector3d now = at(x, y, 10) - at(5, 5, 10), rest(x - 5, y - 5, 0);
    return degrees *
           std::atan2(rest.x() * now.y() - rest.y() * now.x(), rest.x() * now.x() + rest.y() * now.y());
  }
};

const msm::CellStiffness thesis_cell = bodies::cell(31, 47, 33);
constexpr double digit = 5.01e-4; // half of the last digit that the reference prints

} // namespace

// Reference for the three tests: an independent solver's values for k = (31, 47, 33) N/m, three decimals.
TEST_CASE("the cube under tension is as high as an independent solver finds it", "[verification]") {
  const Cube small(bodies::tensile(0.010), thesis_cell), large(bodies::tensile(0.050), thesis_cell);
  CHECK(small.at(5, 5, 10).z() == Approx(10.372).margin(digit));
  CHECK(small.at(0, 0, 10).z() == Approx(10.578).margin(digit));
  CHECK(large.at(5, 5, 10).z() == Approx(11.717).margin(digit));
  CHECK(large.at(0, 0, 10).z() == Approx(12.463).margin(digit));
}

TEST_CASE("the cube under shear leans as an independent solver finds it", "[verification]") {
  const Cube small(bodies::shear(0.002), thesis_cell), large(bodies::shear(0.010), thesis_cell);
  CHECK(small.tilt(0) == Approx(3.276).margin(digit));
  CHECK(small.tilt(10) == Approx(3.346).margin(digit));
  CHECK(large.tilt(0) == Approx(15.501).margin(digit));
  CHECK(large.tilt(10) == Approx(17.209).margin(digit));
}

TEST_CASE("the cube under torsion turns as an independent solver finds it", "[verification]") {
  const Cube small(bodies::torsion(0.005), thesis_cell), large(bodies::torsion(0.025), thesis_cell);
  CHECK(small.twist(10, 5) == Approx(3.264).margin(digit));
  CHECK(small.twist(10, 10) == Approx(4.977).margin(digit));
  CHECK(large.twist(10, 5) == Approx(15.736).margin(digit));
  CHECK(large.twist(10, 10) == Approx(22.425).margin(digit));
}

TEST_CASE("negative springs end in a solve error") {
  const cases::Scene scene = cases::make_scene(bodies::clamped_box({2, 2, 2}, bodies::tensile(0.01)));
  CHECK_THROWS_AS(msm::Model(scene, {bodies::cell(-31, -47, -33)}).solve(), cases::SolveError);
}
