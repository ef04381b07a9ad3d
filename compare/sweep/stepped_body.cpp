#include "compare/sweep/stepped_body.hpp"

#include "compare/provenance/machine.hpp"
#include "mechanics/larger.hpp"
#include "msm/real_time/real_time.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace springproof::compare {

namespace {

using msm::Points;

constexpr double most_timed_seconds = 2;

/// The body as it moves in such steps.
cases::Scene in_steps(const DesignedBody& body, const cases::RealTime& steps) {
  cases::Scene scene = body.scene;
  scene.definition.msm.real_time = steps;
  return scene.definition.dynamics ? scene : msm::in_motion(std::move(scene));
}

/// A body that is stepped.
struct Stepped {
  cases::Scene scene;
  msm::MovingBody body;
  mechanics::IntegrationSettings settings;

  Stepped(const DesignedBody& of, const cases::RealTime& steps)
      : scene(in_steps(of, steps)), body(scene, of.springs, {msm::Path::direct, 1, {}, {}}),
        settings(msm::in_substeps(scene, of.springs, scene.definition.dynamics->step)) {}

  mechanics::Vector start() const { return body.to_vector(Points(scene.mesh.nodes.size(), {0, 0, 0})); }
};

} // namespace

std::vector<cases::RealTime> steps_to_try(const cases::RealTime& given) {
  using cases::StepMethod;
  std::vector<cases::RealTime> all;
  const auto add = [&](StepMethod method, int iterations, std::optional<int> substeps) {
    cases::RealTime one = given;
    one.method = method;
    one.iterations = iterations;
    one.substeps = substeps;
    all.push_back(one);
  };
  for (const StepMethod method : {StepMethod::implicit_euler, StepMethod::projective_dynamics,
                                  StepMethod::vertex_block_descent, StepMethod::xpbd})
    for (const auto& [iterations, substeps] : {std::pair{1, 1}, {10, 1}, {1, 10}, {50, 1}, {1, 50}})
      add(method, iterations, substeps);
  add(StepMethod::symplectic_euler, given.iterations, std::nullopt);
  return all;
}

std::vector<double> time_frames(const DesignedBody& body, const cases::RealTime& steps, int n_frames) {
  Stepped stepped(body, steps);
  const cases::Dynamics& dynamics = *stepped.scene.definition.dynamics;
  const mechanics::Vector start = stepped.start();
  mechanics::TimeIntegrator motion(stepped.body.motion(), dynamics.scheme,
                                   {0, start, mechanics::Vector::Zero(start.size()), {}}, stepped.settings);
  if (body.scene.definition.dynamics) // beyond its end a motion need not hold
    n_frames = std::min(n_frames, std::max(n_first_frames, static_cast<int>(dynamics.n_steps())));
  std::vector<double> seconds;
  const Stopwatch whole;
  Stopwatch frame;
  for (int n = 1; n <= n_frames && (n <= n_first_frames || whole.seconds() < most_timed_seconds); ++n) {
    motion.advance(n * dynamics.step);
    seconds.push_back(frame.lap());
  }
  seconds.erase(seconds.begin());
  return seconds;
}

Rest rest_within(const DesignedBody& body, const cases::RealTime& steps, double within,
                 mechanics::StillMoving still_moving) {
  Rest rest;
  Points before, last; // half a second of motion between them
  try {
    Stepped stepped(body, steps);
    const auto points = [&](const mechanics::Vector& state) {
      before = std::exchange(last, stepped.body.to_points(state));
      for (const Eigen::Vector3d& u : last)
        if (!u.allFinite()) throw cases::SolveError("the body has flown off: a node is at no finite place");
      return last;
    };
    const mechanics::CameToRest found =
        mechanics::come_to_rest({stepped.body.motion(), points, {}}, stepped.start(), steps.step, within,
                                stepped.settings, still_moving);
    rest.solution = msm::solution_of(stepped.body.problem(), found.work, stepped.body.to_points(found.state));
    if (!found.mean_from) return rest;
  } catch (const cases::SolveError& error) {
    rest.solution = error.so_far();
    return rest;
  }
  rest.solution.status = cases::Status::skipped;
  double moved = 0, largest = 0;
  for (std::size_t p = 0; p < last.size(); ++p) {
    moved = mechanics::larger(moved, (last[p] - before[p]).norm());
    largest = mechanics::larger(largest, last[p].norm());
  }
  rest.moves_percent = largest > 0 ? 100 * moved / largest : 0;
  return rest;
}

cases::Solution moved_until(const DesignedBody& body, const cases::RealTime& steps, double end) {
  cases::Scene scene = in_steps(body, steps);
  scene.definition.dynamics->end = end;
  scene.definition.dynamics->write_every = std::numeric_limits<int>::max();
  const auto settings = msm::in_substeps(scene, body.springs, scene.definition.dynamics->step);
  return solve_side([] { return 0; },
                    [&](int) {
                      return msm::follow(scene, body.springs, {msm::Path::direct, 1, {}, {}}, settings);
                    })
      .solution;
}

} // namespace springproof::compare
