#include "compare/sweep/stepped_body.hpp"

#include "cases/case/error.hpp"
#include "cases/case/names.hpp"
#include "compare/interact/moved_body.hpp"
#include "compare/provenance/machine.hpp"
#include "compare/solve/solve.hpp"
#include "mechanics/larger.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <utility>

namespace springproof::compare {

namespace {

using Points = MovedBody::Points;

constexpr double most_timed_seconds = 2;

void ask_for(cases::Scene& scene, const cases::RealTime& steps) {
  scene.definition.msm.real_time = steps;
}
void ask_for(cases::Scene& scene, const cases::ElementRealTime& steps) {
  set_steps(scene, steps);
}

/// The body as it moves in such steps.
cases::Scene in_steps(const SteppedBody& body, const Steps& steps) {
  return std::visit(
      [&](const auto& by) {
        cases::Scene scene = body.scene;
        ask_for(scene, by);
        return scene.definition.dynamics ? scene : mechanics::in_motion(std::move(scene), by);
      },
      steps);
}

/// A body that is stepped, on one thread.
struct Stepped {
  cases::Scene scene;
  std::unique_ptr<MovedBody> body;

  Stepped(const SteppedBody& of, const Steps& steps)
      : scene(in_steps(of, steps)),
        body(of.variant.program == Program::springs ? moved_springs(scene, of.springs, 1)
                                                    : moved_elements(scene, 1)) {}
};

} // namespace

double set_frames(Sweep& sweep) {
  cases::Case& definition = sweep.definition;
  cases::refuse_tools(definition, "sweep --at", "steps in real time know no contact");
  cases::refuse_network(definition, "sweep --at, which designs springs for cells",
                        "judge --method steps the springs of the network");
  if (!definition.material_dynamics.density)
    throw cases::InputError(definition.file +
                            ": material.density: is not there, and steps in time need it; give "
                            "it in kg/m^3: --set material.density=1000");
  if (definition.fem.real_time)
    throw cases::InputError(definition.fem.where,
                            "real_time must be left out of a sweep, whose finite elements are the reference");
  cases::RealTime steps = definition.msm.real_time.value_or(cases::RealTime{});
  steps.step = 1 / sweep.rate->hertz;
  for (const std::string& ignored : set_steps(definition, steps))
    sweep.plan.left_out.push_back({ignored, "steps in real time do not have it"});
  definition.expectations.clear();
  double reference_step = 0;
  if (auto& dynamics = definition.dynamics) {
    const auto n_frames = 2 * static_cast<long>(dynamics->end * sweep.rate->hertz / 2 + 1e-9);
    if (n_frames < 4)
      throw cases::InputError(
          dynamics->where,
          fmt::format("end is {:g} s, must be at least four frames of {:g} s", dynamics->end, steps.step));
    reference_step = steps.step / std::ceil(steps.step / dynamics->step * (1 - 1e-9));
    dynamics->step = steps.step;
    dynamics->end = static_cast<double>(n_frames) * steps.step;
  } else if (!(steps.end >= 1)) {
    throw cases::InputError(
        definition.msm.where,
        fmt::format("real_time.end is {:g} s, must be at least 1 s for a body to rest", steps.end));
  }
  const auto is_other = [&](const cases::Measure& measure) {
    if (!cases::is_of_fields(measure.kind)) return false;
    sweep.plan.left_out.push_back({"measure " + measure.name, "a sweep compares displacements"});
    return true;
  };
  auto& measures = definition.measures;
  measures.erase(std::remove_if(measures.begin(), measures.end(), is_other), measures.end());
  return reference_step;
}

std::vector<Steps> steps_to_try(const AnyMethod& method, const cases::RealTime& given) {
  ClientBudget budget;
  budget.step = given.step;
  budget.model_time = given.end;
  std::vector<Steps> all;
  std::visit(
      [&](auto by) {
        by.damping = given.damping;
        by.chebyshev = given.chebyshev;
        if (cases::is_explicit(by.method)) return void(all.emplace_back(by));
        for (const auto& [iterations, substeps] : {std::pair{1, 1}, {10, 1}, {1, 10}, {50, 1}, {1, 50}}) {
          by.iterations = iterations;
          by.substeps = substeps;
          all.emplace_back(by);
        }
      },
      steps_in(method, budget));
  return all;
}

std::vector<double> time_frames(const SteppedBody& body, const Steps& steps, int n_frames) {
  Stepped stepped(body, steps);
  const cases::Dynamics& dynamics = *stepped.scene.definition.dynamics;
  const mechanics::Vector start = stepped.body->start();
  mechanics::TimeIntegrator motion(stepped.body->motion(), dynamics.scheme,
                                   {0, start, mechanics::Vector::Zero(start.size()), {}},
                                   stepped.body->steps());
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

Rest rest_within(const SteppedBody& body, const Steps& steps, double within,
                 mechanics::StillMoving still_moving) {
  Rest rest;
  Points before, last; // half a second of motion between them
  try {
    Stepped stepped(body, steps);
    const auto points = [&](const mechanics::Vector& state) {
      before = std::exchange(last, stepped.body->to_points(state));
      for (const Eigen::Vector3d& u : last)
        if (!u.allFinite()) throw cases::SolveError("the body has flown off: a node is at no finite place");
      return last;
    };
    const mechanics::CameToRest found = mechanics::come_to_rest(
        {stepped.body->motion(), points, {}}, stepped.body->start(), stepped.scene.definition.dynamics->step,
        within, stepped.body->steps(), still_moving);
    rest.solution = mechanics::to_solution(found.work);
    rest.solution.displacement = stepped.body->to_points(found.state);
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

cases::Solution moved_until(const SteppedBody& body, const Steps& steps, double end) {
  cases::Scene scene = in_steps(body, steps);
  scene.definition.dynamics->end = end;
  scene.definition.dynamics->write_every = std::numeric_limits<int>::max();
  if (body.variant.program != Program::springs) return solve_fem_as_given(scene).solution;
  const auto settings = msm::in_substeps(scene, body.springs, scene.definition.dynamics->step);
  return solve_side([] { return 0; },
                    [&](int) {
                      return msm::follow(scene, body.springs, {msm::Path::direct, 1, {}, {}}, settings);
                    })
      .solution;
}

} // namespace springproof::compare
