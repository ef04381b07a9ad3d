#include "msm/grid/consistent_masses.hpp"

namespace springproof::msm::grid {

using cases::index;

CellMasses::CellMasses(const cases::Grid& grid, const Body& body, const Inertia& inertia)
    : mass(index(body.layout.n_cell_entries()) + 16), damping(mass) {
  std::size_t next = 0;
  for_each_place(grid.cells, [&](int i, int j, int k) {
    if (!grid.has(i, j, k)) return;
    const std::size_t entry = index(body.layout.cell(i, j, k));
    mass[entry] = inertia.cell_mass[next];
    damping[entry] = inertia.cell_mass_damping[next++];
  });
}

template<class Real>
ConsistentMasses<Real>::ConsistentMasses(const Body& body, const CellMasses& cells, int n_threads)
    : body_(body), cells_(cells), n_threads_(n_threads), factored_(cells.mass.size()) {
  for (const std::ptrdiff_t entry : body.constrained) {
    const auto [i, j, k, c] = body.layout.place(entry);
    if (has_cell(body, i, j, k)) held_.push_back(entry);
  }
}

template<class Real>
void ConsistentMasses<Real>::add_product(double mass, double damping, const Field<Real>& direction,
                                         Field<Real>& product) {
  if (mass == 0 && damping == 0) return;
  if (mass != mass_factor_ || damping != damping_) {
    mass_factor_ = mass;
    damping_ = damping;
    for (std::size_t c = 0; c < factored_.size(); ++c)
      factored_[c] = static_cast<Real>(mass * cells_.mass[c] + damping * cells_.damping[c]);
  }
  const mechanics::grid::Masses<Real> masses{factored_.data(), 1, -1};
  mechanics::grid::for_each_layer(body_.cells[2], 0, n_threads_, [&](int k) {
    kernels<Real>().mass(body_.layout, masses, direction.data(), product.data(), k);
  });
  for (const std::ptrdiff_t entry : held_) product[entry] = 0;
}

template class ConsistentMasses<double>;
template class ConsistentMasses<float>;

} // namespace springproof::msm::grid
