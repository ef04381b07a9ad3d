#include "fem_reference/grid/coarse_guess.hpp"

#include "cases/case/error.hpp"
#include "cases/mesh/hex_mesh.hpp"
#include "fem_reference/grid/transfer.hpp"
#include "mechanics/equilibrium/find_equilibrium.hpp"

namespace springproof::fem_reference::grid {

namespace {

using cases::index;
using mechanics::Vector;

constexpr int fewest_nodes = 200;

/// Loads by the transpose of interpolation; supports as those of the fine nodes in the same place.
Supported coarsen(const Supported& fine, const Body& from, const Body& to, const std::array<bool, 3>& axes,
                  int n_threads) {
  Supported coarse;
  coarse.load.setZero(3 * to.layout.size);
  restrict(from.layout, to.layout, axes, fine.load, coarse.load, n_threads);
  coarse.load.array() *= to.free.cast<double>().array();
  std::vector<int> number(index(3 * from.layout.size), -1), taken;
  for (std::size_t m = 0; m < fine.moved.size(); ++m) number[index(fine.moved[m])] = static_cast<int>(m);
  for (int c = 0; c < 3; ++c)
    for (int k = 0; k < to.layout.nodes[2]; ++k)
      for (int j = 0; j < to.layout.nodes[1]; ++j)
        for (int i = 0; i < to.layout.nodes[0]; ++i) {
          const auto fine_node = [&](int n, std::size_t a) {
            return std::min(axes[a] ? 2 * n : n, from.cells[a]);
          };
          const int moved = number[index(c * from.layout.size +
                                         from.layout.at(fine_node(i, 0), fine_node(j, 1), fine_node(k, 2)))];
          if (moved < 0) continue;
          coarse.moved.push_back(c * to.layout.size + to.layout.at(i, j, k));
          taken.push_back(moved);
        }
  if (!taken.empty())
    coarse.prescribed = [taken, all = fine.prescribed](double load_factor) {
      const std::vector<double> values = all(load_factor);
      std::vector<double> own;
      for (const int moved : taken) own.push_back(values[index(moved)]);
      return own;
    };
  return coarse;
}

} // namespace

std::optional<Vector> coarse_guess(const Body& body, const Supported& supported, double load_factor,
                                   int n_threads) {
  const std::array<bool, 3> axes = axes_to_coarsen(body.cells, body.spacing);
  if (!axes[0] && !axes[1] && !axes[2]) return std::nullopt;
  const Body coarse = coarsen(body, axes);
  const Layout &from = coarse.layout, &to = body.layout;
  if (from.nodes[0] * from.nodes[1] * from.nodes[2] < fewest_nodes) return std::nullopt;
  const Supported held = coarsen(supported, body, coarse, axes, n_threads);
  GridEquations equations(coarse, held, n_threads);
  mechanics::EquilibriumSettings settings;
  settings.tolerance = 1e-3; // a guess
  settings.to = load_factor;
  settings.max_newton_per_step = 14;
  settings.easy_newton_per_step = 6;
  settings.smallest_load_step = 0.25;
  settings.max_convexified_per_step = 0;
  settings.stability = mechanics::Stability::ignore;
  settings.guess = coarse_guess(coarse, held, load_factor, n_threads);
  try {
    const Vector found =
        mechanics::find_equilibrium(equations, equations.rest(), "coarse grid", settings).state;
    const Field<double> displacement = found.head(3 * from.size);
    Field<double> fine = Field<double>::Zero(3 * to.size);
    prolong(from, to, axes, displacement, fine, n_threads);
    fine.array() *= body.free.cast<double>().array();
    if (!supported.moved.empty()) {
      const std::vector<double> values = supported.prescribed(load_factor);
      for (std::size_t m = 0; m < values.size(); ++m) fine[supported.moved[m]] = values[m];
    }
    Vector guess = Vector::Zero(3 * to.size + (body.has_modes ? to.n_cell_entries() + 16 : 0));
    guess.head(3 * to.size) = fine;
    if (body.has_modes)
      for (int k = 0; k < body.cells[2]; ++k)
        for (int j = 0; j < body.cells[1]; ++j)
          for (int i = 0; i < body.cells[0]; ++i)
            guess[3 * to.size + to.cell(i, j, k)] =
                found[3 * from.size +
                      from.cell(axes[0] ? i / 2 : i, axes[1] ? j / 2 : j, axes[2] ? k / 2 : k)];
    return guess;
  } catch (const cases::SolveError&) {
    return std::nullopt; // the fine grid has to find its own way
  }
}

} // namespace springproof::fem_reference::grid
