#include "fem_reference/grid/body.hpp"

#include "cases/mesh/hex_mesh.hpp"
#include "mechanics/hexahedron.hpp"

#include <cmath>

namespace springproof::fem_reference::grid {

using cases::index;
using mechanics::grid::for_each_place;

namespace {

bool is_small(const std::array<int, 3>& cells) {
  return (cells[0] + 1) * (cells[1] + 1) * (cells[2] + 1) < 500; // nodes
}

} // namespace

Layout make_layout(const std::array<int, 3>& cells) {
  Layout layout;
  for (int a = 0; a < 3; ++a) layout.nodes[a] = cells[index(a)] + 1;
  layout.row = (layout.nodes[0] + 15) / 16 * 16;
  layout.plane = layout.row * layout.nodes[1] + 16;
  layout.lead = layout.plane + layout.row + 16;
  layout.size = layout.lead + layout.plane * (layout.nodes[2] + 1) + layout.row + 48;
  return layout;
}

Body::Body(const std::array<int, 3>& cells_of_grid, const Slab& slab_, const Eigen::Vector3d& spacing_,
           Law law_, bool has_modes_)
    : cells{cells_of_grid[0], cells_of_grid[1], slab_.n_layers()}, spacing(spacing_),
      layout(make_layout(cells)), slab(slab_), law(law_), has_modes(has_modes_),
      weight(index(layout.n_cell_entries() + 16)), free(Field<float>::Zero(3 * layout.size)) {}

Cells Body::view() const {
  Cells view{};
  view.layout = layout;
  view.law = law;
  view.has_modes = has_modes;
  for (int q = 0; q < 8; ++q) {
    const Eigen::Matrix<double, 3, 8> gradients = mechanics::shape_gradients(mechanics::gauss_point(q));
    for (int a = 0; a < 8; ++a)
      for (int d = 0; d < 3; ++d) view.gradients[q][a][d] = gradients(d, a) / spacing[d];
  }
  view.point_volume = spacing.prod() / 8;
  view.weight = weight.data();
  view.n_parameters = n_parameters;
  view.parameters = has_one_material() ? parameters.data() : nullptr;
  view.cell_parameters = has_one_material() ? nullptr : parameters.data();
  return view;
}

bool has_cell(const Body& body, int i, int j, int k) {
  for (int v = 0; v < 8; ++v) {
    const int a = i - (v & 1), b = j - (v >> 1 & 1), c = k - (v >> 2);
    if (a < 0 || b < 0 || c < 0 || a >= body.cells[0] || b >= body.cells[1] || c >= body.cells[2]) continue;
    if (body.weight[index(body.layout.cell(a, b, c))] > 0) return true;
  }
  return false;
}

Slab deal(const std::array<int, 3>& cells, MPI_Comm communicator, int multiple) {
  return is_small(cells) ? Slab(cells[2] + 1) : Slab(cells[2] + 1, communicator, multiple);
}

Slab coarsen(const Slab& fine, const std::array<int, 3>& cells, bool along_z) {
  return fine.coarser(along_z, is_small(cells) || (along_z && !fine.can_be_halved()));
}

Body coarsen(const Body& fine, const std::array<int, 3>& factor) {
  const std::array<int, 3> fine_cells = fine.cells_of_grid();
  std::array<int, 3> cells;
  Eigen::Vector3d spacing;
  for (std::size_t a = 0; a < 3; ++a) {
    cells[a] = (fine_cells[a] + factor[a] - 1) / factor[a];
    spacing[static_cast<int>(a)] = factor[a] * fine.spacing[static_cast<int>(a)];
  }
  Body coarse(cells, coarsen(fine.slab, cells, factor[2] == 2), spacing, fine.law, fine.has_modes);
  const int first = fine.slab.first_of_grid(), first_coarse = coarse.slab.first_of_grid();
  const float share = 1.0f / static_cast<float>(factor[0] * factor[1] * factor[2]);
  const auto place = [&](int i, int j, int k) {
    return index(coarse.layout.cell(i / factor[0], j / factor[1], (first + k) / factor[2] - first_coarse));
  };
  const auto n_fine = index(fine.layout.n_cell_entries()), n_coarse = index(coarse.layout.n_cell_entries());
  coarse.n_parameters = fine.n_parameters;
  coarse.parameters = fine.parameters;
  if (!fine.has_one_material()) coarse.parameters.assign(index(fine.n_parameters) * n_coarse, 0.);
  for_each_place(fine.cells, [&](int i, int j, int k) {
    const auto from = index(fine.layout.cell(i, j, k)), to = place(i, j, k);
    const float before = coarse.weight[to], added = share * fine.weight[from];
    if (!(added > 0)) return;
    coarse.weight[to] += added;
    if (fine.has_one_material()) return;
    const double part = static_cast<double>(added / (before + added));
    for (std::size_t p = 0; p < index(fine.n_parameters); ++p) {
      double& mean = coarse.parameters[p * n_coarse + to];
      mean += part * (fine.parameters[p * n_fine + from] - mean);
    }
  });
  const std::ptrdiff_t n_of_layer = coarse.layout.cell(0, 0, 1);
  coarse.slab.complete_layers(coarse.weight.data(), n_of_layer);
  if (!fine.has_one_material())
    for (std::size_t p = 0; p < index(fine.n_parameters); ++p)
      coarse.slab.complete_layers(coarse.parameters.data() + p * n_coarse, n_of_layer);
  const auto [begin, end] = coarse.slab.own();
  for (int k = begin; k < end; ++k)
    for (int j = 0; j <= cells[1]; ++j)
      for (int i = 0; i <= cells[0]; ++i) {
        if (!has_cell(coarse, i, j, k)) continue;
        const int a = std::min(factor[0] * i, fine_cells[0]), b = std::min(factor[1] * j, fine_cells[1]),
                  c = std::min(factor[2] * (first_coarse + k), fine_cells[2]) - first;
        const bool is_inside = has_cell(fine, a, b, c);
        for (int d = 0; d < 3; ++d)
          coarse.free[d * coarse.layout.size + coarse.layout.at(i, j, k)] =
              is_inside ? fine.free[d * fine.layout.size + fine.layout.at(a, b, c)] : 1;
      }
  coarse.slab.complete(coarse.layout, coarse.free.data());
  return coarse;
}

} // namespace springproof::fem_reference::grid
