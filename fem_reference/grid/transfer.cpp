#include "fem_reference/grid/transfer.hpp"

#include "cases/mesh/hex_mesh.hpp"

#include <vector>

namespace springproof::fem_reference::grid {

namespace {

using cases::index;

/// Rows that a row is made from, along one axis, and their weights.
struct Stencil {
  int n;
  int at[3];
  double weight[3];
};

Stencil interpolate_from(int i, bool coarsened) {
  if (!coarsened) return {1, {i}, {1}};
  if (i % 2 == 0) return {1, {i / 2}, {1}};
  return {2, {i / 2, i / 2 + 1}, {0.5, 0.5}};
}

Stencil restrict_from(int i, bool coarsened) {
  if (!coarsened) return {1, {i}, {1}};
  return {3, {2 * i - 1, 2 * i, 2 * i + 1}, {0.5, 1, 0.5}};
}

/// sum = weighted rows of a source, over what two stencils select.
template<class Real>
void gather_rows(const Space& space, const Real* source, const Stencil& y, Stencil z, Real* sum) {
  const Layout& layout = space.layout;
  for (int c = 0; c < z.n; ++c) z.at[c] -= space.slab.first_of_grid();
  std::fill(sum, sum + layout.nodes[0], Real(0));
  for (int c = 0; c < z.n; ++c)
    for (int b = 0; b < y.n; ++b) {
      if (y.at[b] < 0 || y.at[b] >= layout.nodes[1] || z.at[c] < 0 || z.at[c] >= layout.nodes[2]) continue;
      const Real weight = static_cast<Real>(y.weight[b] * z.weight[c]);
      const Real* row = source + layout.at(0, y.at[b], z.at[c]);
      for (int i = 0; i < layout.nodes[0]; ++i) sum[i] += weight * row[i];
    }
}

} // namespace

template<class Real>
void prolong(const Space& coarse_space, const Space& fine_space, const std::array<bool, 3>& axes,
             Field<Real>& coarse, Field<Real>& fine) {
  const Layout &from = coarse_space.layout, &to = fine_space.layout;
  coarse_space.slab.update_ghosts(from, coarse.data());
  for_each_plane({0, to.nodes[2]}, fine_space.n_threads, [&](int k) {
    std::vector<Real> row(index(from.nodes[0] + 1));
    const Stencil z = interpolate_from(fine_space.slab.first_of_grid() + k, axes[2]);
    for (int component = 0; component < 3; ++component)
      for (int j = 0; j < to.nodes[1]; ++j) {
        gather_rows(coarse_space, coarse.data() + component * from.size, interpolate_from(j, axes[1]), z,
                    row.data());
        Real* const out = fine.data() + component * to.size + to.at(0, j, k);
        const Real* const in = row.data();
        if (!axes[0])
          for (int i = 0; i < to.nodes[0]; ++i) out[i] = in[i];
        else {
          for (int i = 0; i < to.nodes[0]; i += 2) out[i] = in[i / 2];
          for (int i = 1; i < to.nodes[0]; i += 2) out[i] = Real(0.5) * (in[i / 2] + in[i / 2 + 1]);
        }
      }
  });
}

template<class Real>
void restrict(const Space& fine_space, const Space& coarse_space, const std::array<bool, 3>& axes,
              Field<Real>& fine, Field<Real>& coarse) {
  const Layout &from = fine_space.layout, &to = coarse_space.layout;
  fine_space.slab.update_ghosts(from, fine.data());
  for_each_plane(coarse_space.slab.own(), fine_space.n_threads, [&](int k) {
    // one ghost before, and two after for coarse cells that reach beyond the body
    std::vector<Real> row(index(from.nodes[0] + 4));
    const Stencil z = restrict_from(coarse_space.slab.first_of_grid() + k, axes[2]);
    for (int component = 0; component < 3; ++component)
      for (int j = 0; j < to.nodes[1]; ++j) {
        gather_rows(fine_space, fine.data() + component * from.size, restrict_from(j, axes[1]), z,
                    row.data() + 1);
        Real* const out = coarse.data() + component * to.size + to.at(0, j, k);
        const Real* const in = row.data() + 1;
        if (!axes[0])
          for (int i = 0; i < to.nodes[0]; ++i) out[i] = in[i];
        else
          for (int i = 0; i < to.nodes[0]; ++i)
            out[i] = in[2 * i] + Real(0.5) * (in[2 * i - 1] + in[2 * i + 1]);
      }
  });
  coarse_space.slab.complete(to, coarse.data());
}

template void prolong(const Space&, const Space&, const std::array<bool, 3>&, Field<float>&, Field<float>&);
template void prolong(const Space&, const Space&, const std::array<bool, 3>&, Field<double>&, Field<double>&);
template void restrict(const Space&, const Space&, const std::array<bool, 3>&, Field<float>&, Field<float>&);
template void restrict(const Space&, const Space&, const std::array<bool, 3>&, Field<double>&,
                       Field<double>&);

} // namespace springproof::fem_reference::grid
