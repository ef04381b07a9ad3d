// Part of a model's kernels_source.hpp, in its namespace: products with mass matrices of trilinear cells.
#pragma once

/// Place of a cell's corner after that of its lowest one.
SPRINGPROOF_INLINE std::ptrdiff_t corner_of(const mechanics::grid::Layout& layout, int a) {
  return (a & 1) + (a >> 1 & 1) * layout.row + (a >> 2) * layout.plane;
}

/// Multiplies values of the ends of an edge by [2 1; 1 2].
template<class P>
SPRINGPROOF_INLINE void join(P& a, P& b) {
  const P sum = a + b;
  a += sum;
  b += sum;
}
template<class P>
SPRINGPROOF_INLINE void join_rows(P (&rows)[4]) {
  join(rows[0], rows[1]);
  join(rows[2], rows[3]);
  join(rows[0], rows[2]);
  join(rows[1], rows[3]);
}

/// product += mass * field for layer k of cells, on the planes k and k + 1 of nodes. Rows of cells, each of
/// which ends without a cell, are run through as one.
template<class Real>
void mass_layer(const mechanics::grid::Layout& layout, const mechanics::grid::Masses<Real>& masses,
                const Real* field, Real* product, int k) {
  using P = Pack<Real>;
  const std::ptrdiff_t n = layout.row * (layout.nodes[1] - 1);
  const Real* const of_cell = masses.of_cell + layout.cell(0, 0, k);
  const Real consistent = masses.consistent / 216, lumped = masses.lumped / 8;
  for (int c = 0; c < 3; ++c) {
    P right_before[4] = {}; // what cells of the last pack give to the ends of their edges along x
    bool has_before = false;
    for (std::ptrdiff_t i = 0; i < n; i += pack_size<Real>) {
      P mass = load(of_cell + i);
      if (n - i < pack_size<Real>) mass = first_of(n - i, mass, P{}); // others are the next layer's
      const bool has_any = !all_greater(constant<P>(sizeof(Real) == 8 ? Real(1e-300) : Real(1e-37)), mass);
      if (!has_any && !has_before) continue;
      has_before = has_any;
      const std::ptrdiff_t first = layout.at(0, 0, k, c) + i;
      P left[4], right[4], own_left[4], own_right[4];
      for (int row = 0; row < 4; ++row) {
        const Real* const from = field + first + corner_of(layout, 2 * row);
        left[row] = own_left[row] = load(from);
        right[row] = own_right[row] = load(from + 1);
        join(left[row], right[row]);
      }
      join_rows(left);
      join_rows(right);
      for (int row = 0; row < 4; ++row) {
        const P here = mass * (consistent * left[row] + lumped * own_left[row]),
                there = mass * (consistent * right[row] + lumped * own_right[row]);
        add(product + first + corner_of(layout, 2 * row),
            here + window(right_before[row], there, pack_size<Real> - 1));
        right_before[row] = there;
      }
    }
  }
}
