#include "fem_reference/grid/quadratic_elements.hpp"

#include "cases/mesh/mesh.hpp"
#include "fem_reference/cuboid.hpp"

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
  const Cuboid cuboid(2, 0, cells_.spacing);
  const CellGeometry geometry = cuboid.geometry();
  for (int q = 0; q < 27; ++q) {
    view.weights[q] = geometry.weights[q];
    for (int a = 0; a < 27; ++a)
      for (int j = 0; j < 3; ++j) view.gradients[q][a][j] = geometry.gradients[27 * (3 * q + j) + a];
  }
  return view;
}

bool QuadraticElements::add_force(const double* displacement, double* force, double* cell_volumes) const {
  const ForceFields fields{displacement, nullptr, force, nullptr, cell_volumes};
  const Quadratic elements = view();
  const Checks checks = check_layers(cells_.slab, n_threads_, [&](int k, Checks& of_layer) {
    kernels().quadratic_force(elements, fields, k, of_layer);
  });
  if (force) slab_.add_to_next(nodes_, force);
  return checks.valid;
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
