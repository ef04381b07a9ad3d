#include "fem_reference/grid/grid_body.hpp"
#include "fem_reference/solved_body.hpp"

#include <benchmark/benchmark.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <limits>

using namespace springproof;

namespace element_motions {

namespace {

constexpr int n_steps = 50;

/// A cube of n^3 cells of 1 mm with E = 0.3 MPa, nu = 0.35 and the density of water, held below. Forces of
/// (0.01, 0, 0.02) N a node swing its top at 2 Hz, as in the springs' cube. Implicit Euler.
cases::Scene pulled_cube(int n, cases::Formulation formulation, cases::Element element, double step) {
  cases::Case definition;
  definition.name = "cube";
  definition.body = cases::Box{{1.0 * n, 1.0 * n, 1.0 * n}, {n, n, n}};
  definition.material = cases::LinearElastic{0.3, 0.35};
  definition.material_dynamics.density = 1000;
  definition.fem.formulation = formulation;
  definition.fem.element = element;
  definition.fixed = {{{"z-"}}};
  cases::Load load{{"z+"}, cases::loads::NodalForce{{0.01, 0, 0.02}}};
  load.history.frequency = 2;
  definition.loads = {load};
  cases::Dynamics dynamics;
  dynamics.scheme.scheme = cases::Scheme::implicit_euler;
  dynamics.step = step;
  dynamics.end = n_steps * step;
  dynamics.write_every = std::numeric_limits<int>::max();
  definition.dynamics = dynamics;
  return cases::make_scene(definition);
}

/// Initialises MPI, which the finite elements need on one rank too.
void start_mpi() {
  int is_started = 0;
  MPI_Initialized(&is_started);
  if (is_started != 0) return;
  MPI_Init(nullptr, nullptr);
  std::atexit([] { MPI_Finalize(); });
}

/// Range: cells along an edge, threads, step in ms, -log10 of the tolerance. Times a whole motion
/// without the model's construction; a step's time is the mean over the motion.
void elements(benchmark::State& state, cases::Formulation formulation, cases::Element element) {
  start_mpi();
  const cases::Scene scene = pulled_cube(static_cast<int>(state.range(0)), formulation, element,
                                         1e-3 * static_cast<double>(state.range(2)));
  mechanics::IntegrationSettings settings;
  settings.newton.tolerance = std::pow(10, -static_cast<double>(state.range(3)));
  settings.newton.max_convexified_per_step = 0;
  cases::Solution motion;
  double seconds = 0;
  for (auto _ : state) {
    fem_reference::SolvedBody<fem_reference::grid::GridBody> model(scene, MPI_COMM_SELF,
                                                                   static_cast<int>(state.range(1)));
    const auto start = std::chrono::steady_clock::now();
    motion = model.follow(settings);
    seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() / n_steps;
    state.SetIterationTime(seconds);
  }
  double largest = 0;
  for (const auto& u : motion.displacement) largest = std::max(largest, u.norm());
  state.counters["unknowns"] = static_cast<double>(motion.unknowns);
  state.counters["Newton"] = double(motion.newton_iterations) / n_steps;
  state.counters["linear"] = double(motion.linear_iterations) / n_steps;
  state.counters["halved"] = motion.trajectory->halved_steps;
  state.counters["largest_mm"] = largest;
  state.counters["Munknowns_steps/s"] = static_cast<double>(motion.unknowns) / (1e6 * seconds);
}

} // namespace

BENCHMARK_CAPTURE(elements, log_strain_q1_bbar, cases::Formulation::log_strain, cases::Element::q1_bbar)
    ->ArgNames({"cells", "threads", "step_ms", "tolerance"})
    ->ArgsProduct({{40}, {1, 2}, {1, 20}, {3}})
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1)
    ->UseManualTime();
BENCHMARK_CAPTURE(elements, log_strain_q1_wilson, cases::Formulation::log_strain, cases::Element::q1_wilson)
    ->ArgNames({"cells", "threads", "step_ms", "tolerance"})
    ->ArgsProduct({{40}, {1}, {1, 20}, {3}})
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1)
    ->UseManualTime();
BENCHMARK_CAPTURE(elements, small_strain_q1, cases::Formulation::small_strain, cases::Element::q1)
    ->ArgNames({"cells", "threads", "step_ms", "tolerance"})
    ->ArgsProduct({{40}, {1}, {20}, {3}})
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1)
    ->UseManualTime();

} // namespace element_motions
