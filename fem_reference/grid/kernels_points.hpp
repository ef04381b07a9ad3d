// Part of kernels_source.hpp, in its namespace: cells' displacements, and the laws at their Gauss points.
#pragma once

/// Displacement of a cell's corners: [corner][component].
template<class P>
using Corners = P[8][3];

SPRINGPROOF_INLINE void load_parameter(const double* from, PackD& to) {
  to = load(from);
}
SPRINGPROOF_INLINE void load_parameter(const double* from, PackF& to) {
  to = narrow(load(from), load(from + pack_size<double>));
}

template<class P>
SPRINGPROOF_INLINE Parameters<P> parameters_of(const Cells& cells, std::ptrdiff_t cell) {
  Parameters<P> m;
  m.n = cells.n_parameters;
  for (int e = 0; e < m.n; ++e)
    if (cells.parameters)
      m.value[e] = constant<P>(cells.parameters[e]);
    else {
      load_parameter(cells.cell_parameters + e * cells.layout.n_cell_entries() + cell, m.value[e]);
      m.value[e] = m.value[e] == P{} ? constant<P>(1) : m.value[e]; // where there is no cell
    }
  return m;
}

template<class P>
SPRINGPROOF_INLINE void displacement_gradient(const Cells& cells, int q, const Corners<P>& u, P (&h)[9]) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      P sum{};
      for (int a = 0; a < 8; ++a) sum += u[a][i] * static_cast<RealOf<P>>(cells.gradients[q][a][j]);
      h[3 * i + j] = sum;
    }
}

/// J - 1 as the law's kinematics have it.
template<class L, class P>
SPRINGPROOF_INLINE P dilatation_of(const P (&h)[9]) {
  if constexpr (L::is_finite)
    return growth_of(h);
  else
    return h[0] + h[4] + h[8];
}
template<class L, class P>
SPRINGPROOF_INLINE void cofactor_of(const P (&h)[9], P (&c)[9]) {
  if constexpr (L::is_finite) {
    P f[9];
    deformation_gradient(h, f);
    cofactor(f, c);
  } else
    for (int e = 0; e < 9; ++e) c[e] = constant<P>(e % 4 == 0 ? 1 : 0);
}

/// force += (stress . grad N_a)
template<class P>
SPRINGPROOF_INLINE void add_divergence(const Cells& cells, int q, const P (&stress)[9], Corners<P>& force) {
  for (int a = 0; a < 8; ++a)
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        force[a][i] += stress[3 * i + j] * static_cast<RealOf<P>>(cells.gradients[q][a][j]);
}

/// Displacement of the cells' corners; 0 where there is no cell.
SPRINGPROOF_INLINE void load_corners(const Layout& layout, const double* field, std::ptrdiff_t node,
                                     const PackD& weight, Corners<PackD>& u) {
  for (int a = 0; a < 8; ++a)
    for (int c = 0; c < 3; ++c) {
      const PackD value = load(field + c * layout.size + node + corner_of(layout, a));
      u[a][c] = weight > PackD{} ? value : PackD{};
    }
}

/// Loads the cells' unknowns of their own; 0 where there is no cell.
template<int n>
SPRINGPROOF_INLINE void load_internal(const Cells& cells, const double* internal, std::ptrdiff_t cell,
                                      const PackD& weight, PackD* to) {
  for (int e = 0; e < n; ++e) {
    const PackD value = load(internal + e * cells.layout.n_cell_entries() + cell);
    to[e] = weight > PackD{} ? value : PackD{};
  }
}
template<int n>
SPRINGPROOF_INLINE void load_internal(const Cells& cells, const double* internal, std::ptrdiff_t cell,
                                      const PackF& weight, PackF* to) {
  for (int e = 0; e < n; ++e) {
    const double* const from = internal + e * cells.layout.n_cell_entries() + cell;
    const PackF value = narrow(load(from), load(from + pack_size<double>));
    to[e] = weight > PackF{} ? value : PackF{};
  }
}

/// The stress of a point, with the pressure that its own dilatation has.
template<class L, class P>
SPRINGPROOF_INLINE void stress_of(const P (&h)[9], const Parameters<P>& m, P (&stress)[9]) {
  L::stress(h, m, stress);
  if constexpr (L::has_pressure) {
    P area[9];
    cofactor_of<L>(h, area);
    const P pressure = L::pressure(dilatation_of<L>(h), m).value;
    for (int e = 0; e < 9; ++e) stress[e] += pressure * area[e];
  }
}

/// The moduli dP/dF of a point, with its pressure's.
template<class L, bool modes, class P, class M = typename L::Moduli>
SPRINGPROOF_INLINE void moduli_of(const P (&h)[9], const P& p, const Parameters<P>& m, P (&moduli)[M::n]) {
  L::moduli(h, m, moduli);
  if constexpr (L::has_pressure) {
    P f[9];
    deformation_gradient(h, f);
    if constexpr (modes) {
      if constexpr (L::is_finite) add_cofactor_derivative<M>(f, p, moduli);
    } else {
      const ValueAndSlope<P> pressure = L::pressure(dilatation_of<L>(h), m);
      P area[9];
      cofactor_of<L>(h, area);
      if constexpr (L::is_finite) add_cofactor_derivative<M>(f, pressure.value, moduli);
      for (int r = 0; r < 9; ++r) {
        const P weighted = pressure.slope * area[r];
        for (int s = M::is_symmetric ? r : 0; s < 9; ++s) moduli[M::at(r, s)] += weighted * area[s];
      }
    }
  }
}
