#include "cases/mesh/mesh.hpp"
#include "fem_reference/grid/grid_equations.hpp"

#include <algorithm>
#include <utility>

namespace springproof::fem_reference::grid {

namespace {

using cases::index;
using mechanics::Vector;
using mechanics::grid::CoarseGuess;

constexpr int fewest_nodes = 200;

/// A field's values at the fine nodes in the same places.
Field<double> inject(const Field<double>& fine, const Body& from, const Body& to,
                     const std::array<int, 3>& factor) {
  Field<double> coarse = Field<double>::Zero(3 * to.layout.size);
  const std::array<int, 3> fine_cells = from.cells_of_grid();
  const auto fine_node = [&](int n, std::size_t a) { return std::min(factor[a] * n, fine_cells[a]); };
  const auto [begin, end] = to.slab.own();
  for (int k = begin; k < end; ++k) {
    const int fine_k = fine_node(to.slab.first_of_grid() + k, 2) - from.slab.first_of_grid();
    for (int c = 0; c < 3; ++c)
      for (int j = 0; j < to.layout.nodes[1]; ++j)
        for (int i = 0; i < to.layout.nodes[0]; ++i)
          coarse[c * to.layout.size + to.layout.at(i, j, k)] =
              fine[c * from.layout.size + from.layout.at(fine_node(i, 0), fine_node(j, 1), fine_k)];
  }
  to.slab.complete(to.layout, coarse.data());
  return coarse;
}

/// Coarsens loads by the transpose of interpolation; supports are those of the fine nodes in the same place.
/// @param from, to  must outlive the result
Supported coarsen(const Supported& fine, const Body& from, const Body& to, const std::array<int, 3>& factor,
                  int n_threads) {
  Supported coarse;
  coarse.load.setZero(3 * to.layout.size);
  Field<double> load = fine.load;
  Transfer<double>(from.space(n_threads), to.space(n_threads), factor).restrict(load, coarse.load);
  coarse.load.array() *= to.free.cast<double>().array();
  if (!fine.prescribed) return coarse;
  // every rank takes part, whether or not it has any of these nodes
  const auto injected = [&from, &to, factor, moved = fine.moved](const std::vector<double>& values) {
    Field<double> field = Field<double>::Zero(3 * from.layout.size);
    for (std::size_t m = 0; m < moved.size(); ++m) field[moved[m]] = values[m];
    return inject(field, from, to, factor);
  };
  const Field<double> is_moved = injected(std::vector<double>(fine.moved.size(), 1.));
  for (Eigen::Index entry = 0; entry < is_moved.size(); ++entry)
    if (is_moved[entry] > 0) coarse.moved.push_back(entry);
  coarse.prescribed = [injected, moved = coarse.moved, all = fine.prescribed](double load_factor) {
    const Field<double> field = injected(all(load_factor));
    std::vector<double> values;
    for (const std::ptrdiff_t entry : moved) values.push_back(field[entry]);
    return values;
  };
  return coarse;
}

} // namespace

CoarseGuess coarse_guess(const Body& body, const Supported& supported, double load_factor, int n_threads) {
  const auto factor = mechanics::grid::coarsening_factor(body.cells_of_grid(), body.spacing);
  if (!factor) return {};
  const Body coarse = coarsen(body, *factor);
  const Layout &from = coarse.layout, &to = body.layout;
  if (from.nodes[0] * from.nodes[1] * coarse.slab.n_planes_of_grid() < fewest_nodes) return {};
  const Supported held = coarsen(supported, body, coarse, *factor, n_threads);
  GridEquations equations(coarse, held, n_threads, nullptr, mechanics::grid::guess_tolerance);
  mechanics::EquilibriumSettings settings;
  settings.to = load_factor;
  settings.max_newton_per_step = 14;
  settings.easy_newton_per_step = 6;
  CoarseGuess guess = find_guess(equations, equations.rest(), "coarse grid", settings,
                                 coarse_guess(coarse, held, load_factor, n_threads));
  if (!guess.state) return guess;
  const Vector found = std::move(*guess.state);
  Field<double> displacement = found.head(3 * from.size), fine = Field<double>::Zero(3 * to.size);
  Transfer<double>(body.space(n_threads), coarse.space(n_threads), *factor).prolong(displacement, fine);
  fine.array() *= body.free.cast<double>().array();
  if (supported.prescribed) {
    const std::vector<double> values = supported.prescribed(load_factor);
    for (std::size_t m = 0; m < values.size(); ++m) fine[supported.moved[m]] = values[m];
  }
  Vector& state = guess.state.emplace(Vector::Zero(3 * to.size + body.n_internal()));
  state.head(3 * to.size) = fine;
  const int first = body.slab.first_of_grid(), first_coarse = coarse.slab.first_of_grid();
  if (body.internal == Internal::pressure) // bubbles follow in Newton's first step
    mechanics::grid::for_each_place(body.cells, [&](int i, int j, int k) {
      const std::ptrdiff_t around =
          from.cell(i / (*factor)[0], j / (*factor)[1], (first + k) / (*factor)[2] - first_coarse);
      state[3 * to.size + to.cell(i, j, k)] = found[3 * from.size + around];
    });
  return guess;
}

} // namespace springproof::fem_reference::grid
