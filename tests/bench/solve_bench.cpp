#include "msm/model.hpp"

#include <benchmark/benchmark.h>

using namespace springproof;

namespace {

/// The thesis's cube of n cells of 1 mm an edge, its bottom held, its top nodes pulled by 0.05 N each (the
/// large set).
cases::Scene pulled_cube(int n) {
  cases::Case definition;
  definition.name = "cube";
  definition.body = cases::Box{{1.0 * n, 1.0 * n, 1.0 * n}, {n, n, n}};
  definition.material = cases::LinearElastic{0.3, 0.35};
  definition.fixed.push_back({{"z-", {}, {}}, {true, true, true}});
  definition.loads.push_back({{"z+"}, cases::loads::NodalForce{{0, 0, 0.05}}});
  return cases::make_scene(definition);
}

/// N/mm and MPa: the linear method's springs at nu = 0.35, and the hybrid lattice (t = 0.8) at the same.
const msm::CellStiffness springs{0.031, 0.047, 0.033, 0};
const msm::CellStiffness hybrid{0.0722, 0.0111, 0.0667, 0.1481};
/// The same with power-log springs that soften as log_strain does.
const msm::CellStiffness power_log{0.0722, 0.0111, 0.0667, 0.1481, msm::Exponents{-1.485, -1.485, -1.485}};

/// The midline design's springs of the same material, beta = 0.8.
const msm::CellStiffness midline{0.0239, 0.0111, 0.0667, 0.1481, {}, 0.193};

/// Range: cells along an edge, threads. From rest to a residual of 1e-9; setting up is not counted.
void solve(benchmark::State& state, const msm::CellStiffness& cell) {
  const cases::Scene scene = pulled_cube(static_cast<int>(state.range(0)));
  cases::Solution solution;
  for (auto _ : state) {
    state.PauseTiming();
    msm::ModelOptions options;
    options.n_threads = static_cast<int>(state.range(1));
    msm::Model model(scene, {cell}, options);
    state.ResumeTiming();
    solution = model.solve();
  }
  state.counters["unknowns"] = static_cast<double>(solution.unknowns);
  state.counters["per unknown"] =
      benchmark::Counter(static_cast<double>(solution.unknowns),
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  state.counters["Newton"] = solution.newton_iterations;
  state.counters["CG"] = static_cast<double>(solution.linear_iterations);
  state.counters["residual"] = solution.residual;
}
BENCHMARK_CAPTURE(solve, springs, springs)
    ->ArgNames({"cells", "threads"})
    ->ArgsProduct({{10, 20, 40, 80, 100}, {1, 2}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(solve, hybrid, hybrid)
    ->ArgNames({"cells", "threads"})
    ->ArgsProduct({{10, 20, 40}, {1, 2}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(solve, midline, midline)
    ->ArgNames({"cells", "threads"})
    ->ArgsProduct({{10, 20, 40}, {1, 2}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(solve, power_log, power_log)
    ->ArgNames({"cells", "threads"})
    ->ArgsProduct({{10, 20, 40}, {1, 2}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

} // namespace
