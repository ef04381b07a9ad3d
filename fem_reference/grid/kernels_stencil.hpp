// Part of kernels_source.hpp, in its namespace: matrices of 3x3 blocks on a grid.
#pragma once

/// Adds cell matrices to a matrix's rows.
/// @param entry  returns entry (row, column) of the pack's cell matrices
/// @param first  place of the lowest cell in its row
template<class Entry>
SPRINGPROOF_INLINE void add_to_stencil(const Layout& layout, const Entry& entry, float* stencil, int first,
                                       int j, int k) {
  for (int a = 0; a < 8; ++a) {
    float* const row =
        stencil + stencil_row(layout) * layout.node_row(j + (a >> 1 & 1), k + (a >> 2)) + first + (a & 1);
    for (int b = 0; b < 8; ++b) {
      const int dx = (b & 1) - (a & 1), dy = (b >> 1 & 1) - (a >> 1 & 1), dz = (b >> 2) - (a >> 2);
      float* const block = row + 9 * (dx + 1 + 3 * (dy + 1) + 9 * (dz + 1)) * layout.row;
      for (int c = 0; c < 3; ++c)
        for (int d = 0; d < 3; ++d) add(block + (3 * c + d) * layout.row, entry(3 * a + c, 3 * b + d));
    }
  }
}

/// Weights of a coarse cell's lower corner along an axis at the two corners of its fine cell. Those of the
/// upper corner are 1 minus these.
struct Weights {
  PackF of_lower, of_upper;
};

/// matrix = P^T matrix P along one axis: mixes rows and columns whose corners differ in the bit `axis`.
SPRINGPROOF_INLINE void interpolate(PackF (&matrix)[24][24], int axis, const Weights& w) {
  const PackF lower[2] = {w.of_lower, 1 - w.of_lower}, upper_[2] = {w.of_upper, 1 - w.of_upper};
#pragma GCC unroll 1
  for (int r = 0; r < 24; ++r) {
    if ((r / 3) >> axis & 1) continue;
    const int other = r + (3 << axis);
#pragma GCC unroll 4
    for (int s = 0; s < 24; ++s) {
      const PackF a = matrix[r][s], b = matrix[other][s];
      matrix[r][s] = lower[0] * a + upper_[0] * b;
      matrix[other][s] = lower[1] * a + upper_[1] * b;
    }
  }
#pragma GCC unroll 1
  for (int r = 0; r < 24; ++r)
    for (int s = 0; s < 24; ++s) {
      if ((s / 3) >> axis & 1) continue;
      const int other = s + (3 << axis);
      const PackF a = matrix[r][s], b = matrix[r][other];
      matrix[r][s] = lower[0] * a + upper_[0] * b;
      matrix[r][other] = lower[1] * a + upper_[1] * b;
    }
}

SPRINGPROOF_INLINE Weights weights_of(bool upper_child) {
  return upper_child ? Weights{constant<PackF>(0.5), constant<PackF>(0)}
                     : Weights{constant<PackF>(1), constant<PackF>(0.5)};
}
/// Weights of neighbouring cells, the first of which is a lower child.
SPRINGPROOF_INLINE Weights weights_of_row() {
  Weights w{};
  for (int l = 0; l < pack_size<float>; ++l) {
    w.of_lower[l] = l % 2 == 0 ? 1 : 0.5f;
    w.of_upper[l] = l % 2 == 0 ? 0.5f : 0;
  }
  return w;
}

/// Adds cell matrices to those of the coarser grid, by the trilinear interpolation between them.
SPRINGPROOF_INLINE void add_to_coarse(const PackF (&cell)[n_upper], float* coarse, const Coarsening& c,
                                      int first, int j, int k) {
  PackF matrix[24][24];
  for (int r = 0; r < 24; ++r)
    for (int s = 0; s < 24; ++s) matrix[r][s] = cell[upper(r, s)];
  if (c.axes[0]) interpolate(matrix, 0, weights_of_row());
  if (c.axes[1]) interpolate(matrix, 1, weights_of(j % 2 == 1));
  const int z = c.first + k;
  if (c.axes[2]) interpolate(matrix, 2, weights_of(z % 2 == 1));
  const int i = c.axes[0] ? first / 2 : first;
  const std::ptrdiff_t of_row =
      c.layout.cell(0, c.axes[1] ? j / 2 : j, (c.axes[2] ? z / 2 : z) - c.first_coarse);
  float* const to = coarse + n_upper * of_row + i;
  for (int r = 0; r < 24; ++r)
    for (int s = r; s < 24; ++s) {
      float* const entry = to + upper(r, s) * c.layout.row;
      const PackF value = matrix[r][s];
      if (c.axes[0])
        for (int l = 0; l < pack_size<float> / 2; ++l) entry[l] += value[2 * l] + value[2 * l + 1];
      else
        add(entry, value);
    }
}

void deposit_layer(const Layout& layout, const float* cells, float* stencil, float* coarse,
                   const Coarsening& coarsening, int k) {
  const int n = layout.nodes[0] - 1;
  for (int j = 0; j < layout.nodes[1] - 1; ++j)
    for (int i = 0; i < n; i += pack_size<float>) {
      const float* from = cells + n_upper * layout.cell(0, j, k) + i;
      PackF cell[n_upper];
      for (int e = 0; e < n_upper; ++e) cell[e] = load(from + e * layout.row);
      add_to_stencil(
          layout, [&](int r, int s) { return cell[upper(r, s)]; }, stencil, i, j, k);
      if (coarse) add_to_coarse(cell, coarse, coarsening, i, j, k);
    }
}

// ---- products ---------------------------------------------------------------------------------------------

template<class Real>
struct PackFor {
  using type = PackD;
};
template<>
struct PackFor<float> {
  using type = PackF;
};
SPRINGPROOF_INLINE PackD load_as(const float* from, double) {
  return load_wide(from);
}
SPRINGPROOF_INLINE PackF load_as(const float* from, float) {
  return load(from);
}

/// Computes the product for n packs of a row of nodes.
template<int n, class Real>
SPRINGPROOF_INLINE void product_of_packs(const Layout& layout, const float* row, const Real* field,
                                         const float* free, Real* product) {
  using P = typename PackFor<Real>::type;
  P sum[3][n] = {};
#pragma GCC unroll 1
  for (int dz = -1; dz <= 1; ++dz)
#pragma GCC unroll 1
    for (int dy = -1; dy <= 1; ++dy)
#pragma GCC unroll 1
      for (int dx = -1; dx <= 1; ++dx) {
        const Real* const at = field + dz * layout.plane + dy * layout.row + dx;
        P x[3][n];
        for (int d = 0; d < 3; ++d)
          for (int p = 0; p < n; ++p) x[d][p] = load(at + d * layout.size + p * pack_size<RealOf<P>>);
        for (int c = 0; c < 3; ++c)
          for (int d = 0; d < 3; ++d) {
            for (int p = 0; p < n; ++p)
              sum[c][p] += load_as(row + p * pack_size<RealOf<P>>, Real()) * x[d][p];
            row += layout.row;
          }
      }
  for (int c = 0; c < 3; ++c)
    for (int p = 0; p < n; ++p) {
      const std::ptrdiff_t at = c * layout.size + p * pack_size<RealOf<P>>;
      store(product + at, free ? sum[c][p] * load_as(free + at, Real()) : sum[c][p]);
    }
}

template<class Real>
void product_plane(const Layout& layout, const float* stencil, const Real* field, const float* free,
                   Real* product, int k) {
  using P = typename PackFor<Real>::type;
  const std::ptrdiff_t n_packs = (layout.nodes[0] + pack_size<RealOf<P>> - 1) / pack_size<RealOf<P>>;
  for (int j = 0; j < layout.nodes[1]; ++j) {
    const float* row = stencil + stencil_row(layout) * layout.node_row(j, k);
    const std::ptrdiff_t first = layout.at(0, j, k);
    for (std::ptrdiff_t p = 0; p < n_packs;) {
      const std::ptrdiff_t at = p * pack_size<RealOf<P>>, left = n_packs - p;
      const auto run = [&](auto n) {
        product_of_packs<decltype(n)::value>(layout, row + at, field + first + at,
                                             free ? free + first + at : nullptr, product + first + at);
        p += decltype(n)::value;
      };
      if (left >= 4)
        run(Count<4>{});
      else if (left == 3)
        run(Count<3>{});
      else if (left == 2)
        run(Count<2>{});
      else
        run(Count<1>{});
    }
  }
}
