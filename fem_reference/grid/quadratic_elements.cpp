#include "fem_reference/grid/quadratic_elements.hpp"

#include "cases/mesh/hex_mesh.hpp"

#include <cmath>
#include <utility>

namespace springproof::fem_reference::grid {

using cases::index;

QuadraticElements::QuadraticElements(const Body& nodes, Body cells, int n_threads)
    : cells_(std::move(cells)), slab_(nodes.slab), nodes_(nodes.layout), above_first_(nodes.layout),
      n_threads_(n_threads) {
  above_first_.lead += slab_.own().begin * nodes_.plane;
}

Quadratic QuadraticElements::view() const {
  Quadratic view{cells_.view(), above_first_, {}, {}};
  // on the unit interval: nodes at 0, 1/2, 1; Gauss points
  const double at[3] = {0.5 - std::sqrt(0.15), 0.5, 0.5 + std::sqrt(0.15)},
               weight[3] = {5. / 18, 4. / 9, 5. / 18};
  double value[3][3], slope[3][3];
  for (int p = 0; p < 3; ++p) {
    const double x = at[p];
    const double n[3] = {(1 - x) * (1 - 2 * x), 4 * x * (1 - x), x * (2 * x - 1)},
                 d[3] = {4 * x - 3, 4 - 8 * x, 4 * x - 1};
    for (int a = 0; a < 3; ++a) {
      value[p][a] = n[a];
      slope[p][a] = d[a];
    }
  }
  for (int q = 0; q < 27; ++q) {
    const int p[3] = {q % 3, q / 3 % 3, q / 9};
    view.weights[q] = weight[p[0]] * weight[p[1]] * weight[p[2]] * cells_.spacing.prod();
    for (int a = 0; a < 27; ++a) {
      const int n[3] = {a % 3, a / 3 % 3, a / 9};
      for (int j = 0; j < 3; ++j) {
        double product = 1 / cells_.spacing[j];
        for (int d = 0; d < 3; ++d) product *= d == j ? slope[p[d]][n[d]] : value[p[d]][n[d]];
        view.gradients[q][a][j] = product;
      }
    }
  }
  return view;
}

bool QuadraticElements::add_force(const double* displacement, double* force, double* cell_volumes) const {
  const ForceFields fields{displacement, nullptr, force, nullptr, cell_volumes};
  const Quadratic elements = view();
  std::vector<Checks> checks(index(cells_.cells[2]));
  for_each_layer(cells_.slab, n_threads_,
                 [&](int k) { kernels().quadratic_force(elements, fields, k, checks[index(k)]); });
  if (force) slab_.add_to_next(nodes_, force);
  return std::all_of(checks.begin(), checks.end(), [](const Checks& c) { return c.valid; });
}

void QuadraticElements::linearise(const double* displacement) {
  const int n_entries = with_law(cells_.law, [](auto law) { return decltype(law)::Moduli::n; });
  moduli_.resize(index(27 * n_entries * cells_.layout.n_cell_entries()));
  const Quadratic elements = view();
  for_each_plane({0, cells_.cells[2]}, n_threads_,
                 [&](int k) { kernels().quadratic_moduli(elements, displacement, moduli_.data(), k); });
}

void QuadraticElements::product(Field<double>& field, Field<double>& product) const {
  slab_.update_ghosts(nodes_, field.data());
  const Quadratic elements = view();
  product.setZero();
  for_each_layer(cells_.slab, n_threads_, [&](int k) {
    kernels().quadratic_product(elements, moduli_.data(), field.data(), product.data(), k);
  });
  slab_.add_to_next(nodes_, product.data());
}

} // namespace springproof::fem_reference::grid
