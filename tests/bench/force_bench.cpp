#include "compare/sweep/timed_cube.hpp"
#include "msm/grid/spring_levels.hpp"
#include "msm/spring_body.hpp"
#include "tests/bench/peak.hpp"

#include <benchmark/benchmark.h>

using namespace springproof;

namespace {

using msm::Clamp;
using msm::grid::Body;
using msm::grid::Field;

double n_nodes(const Body& body) {
  return (body.cells[0] + 1.0) * (body.cells[1] + 1.0) * (body.cells[2] + 1.0);
}

void count_nodes(benchmark::State& state, double nodes) {
  state.counters["per node"] =
      benchmark::Counter(nodes, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

/// Additions and multiplications for one spring's force, as the kernels do it: the difference of two
/// displaced nodes 3, its square 6, the reciprocal root from the estimate 10, k - k l0/|d| 2, times the
/// difference to both ends 12.
constexpr double flops_per_spring = 33;

/// Range: cells along an edge, threads.
template<class Real>
void grid_force(benchmark::State& state) {
  const Body body = compare::timed_cube(static_cast<int>(state.range(0)));
  const msm::grid::SpringField<Real> springs(body, static_cast<int>(state.range(1)));
  Field<Real> displacement = Field<Real>::Zero(3 * body.layout.size), force = displacement;
  for (auto _ : state) springs.force(displacement, force);
  count_nodes(state, n_nodes(body));
  state.counters["of peak"] =
      benchmark::Counter(flops_per_spring * msm::grid::n_springs * n_nodes(body) /
                             (peak_flops<Real>() * static_cast<double>(state.range(1))),
                         benchmark::Counter::kIsIterationInvariantRate);
  state.SetLabel(mechanics::grid::name_of(mechanics::grid::instruction_set()));
}
BENCHMARK_TEMPLATE(grid_force, double)->Args({40, 1})->Args({40, 2})->UseRealTime();
BENCHMARK_TEMPLATE(grid_force, float)->Args({40, 1})->Args({40, 2})->UseRealTime();

enum class With { springs, volume, midlines };

/// @tparam with  volume terms beside the springs, and midlines beside both
template<class Real, bool is_power_log = false, With with = With::springs>
void grid_product(benchmark::State& state) {
  Body body = compare::timed_cube(static_cast<int>(state.range(0)));
  for (msm::grid::CellSprings& cell : body.springs) {
    if (with != With::springs) cell.volume = 0.14;
    if (with == With::midlines) cell.midline = {0.1, 0.1, 0.1};
  }
  if (is_power_log) body.exponents = msm::Exponents{-1.3, -1.8, -2.2};
  const msm::grid::SpringField<Real> springs(body, static_cast<int>(state.range(1)));
  Field<Real> displacement = Field<Real>::Zero(3 * body.layout.size), direction = displacement,
              product = displacement;
  for (auto _ : state) springs.product(Clamp::yes, displacement, direction, product);
  count_nodes(state, n_nodes(body));
}
BENCHMARK_TEMPLATE(grid_product, double)->Args({40, 1})->Args({40, 2})->UseRealTime();
BENCHMARK_TEMPLATE(grid_product, float)->Args({40, 1})->Args({40, 2})->UseRealTime();
BENCHMARK_TEMPLATE(grid_product, double, true)->Args({40, 1})->UseRealTime();
BENCHMARK_TEMPLATE(grid_product, float, true)->Args({40, 1})->UseRealTime();
BENCHMARK_TEMPLATE(grid_product, double, false, With::volume)->Args({40, 1})->UseRealTime();
BENCHMARK_TEMPLATE(grid_product, double, false, With::midlines)->Args({40, 1})->UseRealTime();
BENCHMARK_TEMPLATE(grid_product, float, false, With::volume)->Args({40, 1})->UseRealTime();
BENCHMARK_TEMPLATE(grid_product, float, false, With::midlines)->Args({40, 1})->UseRealTime();
BENCHMARK_TEMPLATE(grid_product, double, true, With::volume)->Args({40, 1})->UseRealTime();
BENCHMARK_TEMPLATE(grid_product, double, true, With::midlines)->Args({40, 1})->UseRealTime();

void multigrid_cycle(benchmark::State& state) {
  const Body body = compare::timed_cube(static_cast<int>(state.range(0)));
  msm::grid::SpringLevels multigrid(body, static_cast<int>(state.range(1)));
  Field<double> field = Field<double>::Zero(3 * body.layout.size), solution = field;
  multigrid.linearise(field);
  field[body.layout.at(1, 1, body.cells[2])] = 1;
  for (auto _ : state) multigrid.apply(field, solution);
  count_nodes(state, n_nodes(body));
}
BENCHMARK(multigrid_cycle)->Args({40, 1})->Args({40, 2})->UseRealTime();

/// Times the same force, computed from the list of springs.
void list_force(benchmark::State& state) {
  const int n = static_cast<int>(state.range(0));
  const msm::Lattice lattice = msm::make_lattice(cases::make_box_mesh({n * 1.0, n * 1.0, n * 1.0}, {n, n, n}),
                                                 {{0.031, 0.047, 0.033, 0}});
  for (auto _ : state) benchmark::DoNotOptimize(msm::internal_force(lattice, lattice.rest));
  count_nodes(state, static_cast<double>(lattice.rest.size()));
}
BENCHMARK(list_force)->Arg(40)->UseRealTime();

} // namespace
