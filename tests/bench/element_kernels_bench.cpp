#include "cases/mesh/mesh.hpp"
#include "fem_reference/grid/stencil_levels.hpp"

#include <benchmark/benchmark.h>

#include <cmath>

using namespace springproof::fem_reference::grid;

namespace element_kernels {

namespace {

/// A cube of n^3 cells of 1 mm with E = 0.3 MPa and nu = 0.35, bent a little.
struct Cube {
  Cube(int n, Law law, Internal internal) : body({n, n, n}, Slab(n + 1), {1, 1, 1}, law, internal) {
    body.parameters = {0.1111, 0.3333};
    body.n_parameters = 2;
    body.free.setOnes();
    internals.resize(springproof::cases::index(body.n_internal()));
    displacement.setZero(3 * body.layout.size);
    for (int k = 0; k <= n; ++k)
      for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) {
          if (i < n && j < n && k < n) body.weight[springproof::cases::index(body.layout.cell(i, j, k))] = 1;
          displacement[body.layout.at(i, j, k, 0)] = 0.05 * n * std::sin(1. * k / n);
          displacement[body.layout.at(i, j, k, 2)] = 0.02 * n * std::sin(2. * j / n);
        }
  }
  double n_unknowns() const { return 3 * std::pow(body.cells[0] + 1, 3); }

  Body body;
  Field<double> displacement;
  std::vector<double> internals;
};

/// Range: cells along an edge. One thread.
template<class Run>
void measure(benchmark::State& state, const Cube& cube, const Run& run) {
  for (auto _ : state) run();
  state.counters["per_unknown"] = benchmark::Counter(
      cube.n_unknowns(), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

/// Forces, and those with the imbalance of the cells' unknowns where there are any: what a state takes.
void force(benchmark::State& state, Law law, Internal internal) {
  const Cube cube(static_cast<int>(state.range(0)), law, internal);
  Field<double> plain = cube.displacement, condensed = plain;
  const ForceFields fields{cube.displacement.data(), cube.internals.data(), plain.data(),
                           internal == Internal::none ? nullptr : condensed.data(), nullptr};
  const Cells view = cube.body.view();
  measure(state, cube, [&] {
    check_layers(cube.body.slab, 1, [&](int k, Checks& checks) { kernels().force(view, fields, k, checks); });
  });
}

/// The tangent and the matrices of every level of the cycle: what a linearisation takes.
void linearise(benchmark::State& state, Law law, Internal internal) {
  const Cube cube(static_cast<int>(state.range(0)), law, internal);
  StencilLevels levels(cube.body, 1, {3, 12});
  measure(state, cube, [&] { levels.linearise(cube.displacement.data(), cube.internals.data()); });
}

void product(benchmark::State& state, Law law, Internal internal) {
  const Cube cube(static_cast<int>(state.range(0)), law, internal);
  StencilLevels levels(cube.body, 1, {3, 12});
  levels.linearise(cube.displacement.data(), cube.internals.data());
  Field<double> field = cube.displacement, result = field;
  measure(state, cube, [&] { levels.product(field, result); });
}

} // namespace

#define SPRINGPROOF_ELEMENT(kernel)                                                                          \
  BENCHMARK_CAPTURE(kernel, elements_small_strain_q1_bbar, Law::small_strain, Internal::pressure)->Arg(40);  \
  BENCHMARK_CAPTURE(kernel, elements_small_strain_q1_wilson, Law::small_strain, Internal::bubbles)->Arg(40); \
  BENCHMARK_CAPTURE(kernel, elements_log_strain_q1_bbar, Law::log_strain, Internal::pressure)->Arg(40);      \
  BENCHMARK_CAPTURE(kernel, elements_log_strain_q1_wilson, Law::log_strain, Internal::bubbles)->Arg(40)
SPRINGPROOF_ELEMENT(force);
SPRINGPROOF_ELEMENT(linearise);
SPRINGPROOF_ELEMENT(product);

} // namespace element_kernels
