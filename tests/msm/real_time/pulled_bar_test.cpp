#include "tests/msm/real_time/bar.hpp"

#include <catch2/catch.hpp>

using namespace springproof;
using cases::StepMethod;
using Eigen::Vector3d;

/// Displacement of a bar after three steps, with the end of it pulled by a spring from the second on.
/// @param part  of the load and of the way that the spring is drawn
static msm::Points pulled_bar(StepMethod method, int iterations, double stiffness, double part,
                              bool is_solved) {
  cases::Scene scene = bar(method, iterations, part * sideways);
  if (is_solved) scene.definition.msm.real_time.reset();
  msm::MovingBody body(scene, {springs_of_cells}, {msm::Path::direct, 1, {}, {}});
  const auto settings =
      is_solved ? mechanics::IntegrationSettings{} : msm::in_substeps(scene, {springs_of_cells}, 0.01);
  const msm::Points rest(scene.mesh.nodes.size(), Vector3d::Zero());
  const mechanics::Vector start = body.to_vector(rest);
  mechanics::TimeIntegrator motion(body.motion(), scene.definition.dynamics->scheme,
                                   {0, start, mechanics::Vector::Zero(start.size()), {}}, settings);
  motion.advance(0.01);
  std::vector<cases::NodeWeight> place; // that has nodes of the supports too
  for (int node = 0; node < 4; ++node) place.push_back({node, 0.1});
  place.push_back({static_cast<int>(rest.size()) - 1, 0.6});
  body.hold(place, stiffness).draw_to(part * Vector3d(2, -1, 1));
  for (int n = 2; n <= 3; ++n) motion.advance(0.01 * n);
  return body.to_points(motion.now().displacement);
}

TEST_CASE("a body that is pulled comes to the motion that Newton's method finds, by every method",
          "[verification]") {
  constexpr double stiffness = 5; // N/mm: beside the springs' 0.1 to 0.3
  for (const StepMethod method : {StepMethod::projective_dynamics, StepMethod::vertex_block_descent,
                                  StepMethod::implicit_euler, StepMethod::xpbd}) {
    // What the turning of XPBD's gradients leaves is of first order in the motion.
    const double part = method == StepMethod::xpbd ? 1e-5 : 1;
    const msm::Points solved = pulled_bar(method, 1, stiffness, part, true);
    const auto left = [&](int n) { return apart(pulled_bar(method, n, stiffness, part, false), solved); };
    const double few = left(5), many = left(3000);
    CAPTURE(cases::name_of(method), few, many);
    CHECK(few > 1e-4);
    CHECK(many < 1e-4);
  }
}

TEST_CASE("a method that begins anew makes the same steps again") {
  const cases::Scene scene = bar(StepMethod::vertex_block_descent, 5, sideways); // begins with what it knows
  msm::MovingBody body(scene, {springs_of_cells}, {msm::Path::direct, 1, {}, {}});
  const mechanics::Vector rest = body.to_vector(msm::Points(scene.mesh.nodes.size(), Vector3d::Zero()));
  const auto moved = [&] {
    body.motion().begin_anew();
    mechanics::TimeIntegrator motion(body.motion(), scene.definition.dynamics->scheme,
                                     {0, rest, mechanics::Vector::Zero(rest.size()), {}},
                                     msm::in_substeps(scene, {springs_of_cells}, 0.01));
    for (int n = 1; n <= 5; ++n) motion.advance(0.01 * n);
    return mechanics::Vector(motion.now().displacement);
  };
  const mechanics::Vector first = moved();
  CHECK(first.norm() > 0);
  CHECK(moved() == first);
}
