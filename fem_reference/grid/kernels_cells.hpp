// Part of kernels_source.hpp, in its namespace: forces, tangents and masses of cells.
#pragma once

/// Displacement of a cell's corners: [corner][component].
template<class P>
using Corners = P[8][3];

SPRINGPROOF_INLINE std::ptrdiff_t corner_of(const Layout& layout, int a) {
  return (a & 1) + (a >> 1 & 1) * layout.row + (a >> 2) * layout.plane;
}

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

template<class L, bool modes>
void force_layer(const Cells& cells, const ForceFields& fields, int k, Checks& checks) {
  const Layout& layout = cells.layout;
  PackD mismatch{};
  for (int j = 0; j < layout.nodes[1] - 1; ++j)
    for (int i = 0; i < layout.nodes[0] - 1; i += pack_size<double>) {
      const std::ptrdiff_t cell = layout.cell(i, j, k), node = layout.at(i, j, k);
      const PackD weight = load_wide(cells.weight + cell);
      if (!all_greater(weight, constant<PackD>(-1)) || all_greater(constant<PackD>(1e-30), weight)) continue;
      Corners<PackD> u, force{}, volume_gradient{};
      load_corners(layout, fields.displacement, node, weight, u);
      const Parameters<PackD> m = parameters_of<PackD>(cells, cell);
      PackD p{}, growth{}, volume{}, lowest{};
      ValueAndSlope<PackD> target{};
      if constexpr (modes) {
        p = load(fields.pressure + cell);
        p = weight > PackD{} ? p : PackD{};
        target = L::dilatation(p, m);
      }
#pragma GCC unroll 1
      for (int q = 0; q < 8; ++q) {
        PackD h[9], stress[9];
        displacement_gradient(cells, q, u, h);
        const PackD dilatation = dilatation_of<L>(h);
        lowest = dilatation > lowest ? lowest : dilatation; // keeps what is not a number
        L::stress(h, m, stress);
        if constexpr (L::has_pressure) {
          PackD area[9];
          cofactor_of<L>(h, area);
          PackD pressure = p;
          if constexpr (!modes) pressure = L::pressure(dilatation, m).value;
          for (int e = 0; e < 9; ++e) stress[e] += pressure * area[e];
          if (modes && fields.condensed) add_divergence(cells, q, area, volume_gradient);
        }
        add_divergence(cells, q, stress, force);
        growth += dilatation;
        if (fields.volume) volume += 1 + (L::is_finite ? dilatation : growth_of(h));
      }
      const PackD least = constant<PackD>(L::is_finite ? -1 : -1e100);
      if (!all_greater(lowest, least)) {
        checks.valid = false;
        return;
      }
      const PackD scale = weight * cells.point_volume;
      PackD change{};
      if constexpr (modes) {
        const PackD off = growth / 8 - target.value; // R over the rest volume
        change = off / target.slope;
        const PackD size = weight > PackD{} ? absolute(off) : PackD{};
        mismatch = larger(size, mismatch);
      }
      if (fields.volume)
        store(fields.volume + cell, weight > PackD{} ? volume * cells.point_volume : PackD{});
      for (int a = 0; a < 8; ++a)
        for (int c = 0; c < 3; ++c) {
          const std::ptrdiff_t at = c * layout.size + node + corner_of(layout, a);
          if (fields.force) add(fields.force + at, scale * force[a][c]);
          if (fields.condensed)
            add(fields.condensed + at, scale * (force[a][c] + change * volume_gradient[a][c]));
        }
    }
  for (int l = 0; l < pack_size<double>; ++l)
    if (mismatch[l] > checks.volume_mismatch) checks.volume_mismatch = mismatch[l];
}

template<class L>
void pressure_change_layer(const Cells& cells, const ForceFields& fields, const double* step, double* change,
                           int k) {
  const Layout& layout = cells.layout;
  for (int j = 0; j < layout.nodes[1] - 1; ++j)
    for (int i = 0; i < layout.nodes[0] - 1; i += pack_size<double>) {
      const std::ptrdiff_t cell = layout.cell(i, j, k), node = layout.at(i, j, k);
      const PackD weight = load_wide(cells.weight + cell);
      Corners<PackD> u, du;
      load_corners(layout, fields.displacement, node, weight, u);
      load_corners(layout, step, node, weight, du);
      const Parameters<PackD> m = parameters_of<PackD>(cells, cell);
      const PackD p = weight > PackD{} ? load(fields.pressure + cell) : PackD{};
      const ValueAndSlope<PackD> target = L::dilatation(p, m);
      PackD growth{};
#pragma GCC unroll 1
      for (int q = 0; q < 8; ++q) {
        PackD h[9], dh[9], area[9];
        displacement_gradient(cells, q, u, h);
        displacement_gradient(cells, q, du, dh);
        cofactor_of<L>(h, area);
        growth += dilatation_of<L>(h);
        for (int e = 0; e < 9; ++e) growth += area[e] * dh[e];
      }
      const PackD result = (growth / 8 - target.value) / target.slope;
      store(change + cell, weight > PackD{} ? result : PackD{});
    }
}

/// The moduli dP/dF of a point, with its pressure's.
template<class L, bool modes, class M = typename L::Moduli>
SPRINGPROOF_INLINE void moduli_of(const PackF (&h)[9], const PackF& p, const Parameters<PackF>& m,
                                  PackF (&moduli)[M::n]) {
  L::moduli(h, m, moduli);
  if constexpr (L::has_pressure) {
    PackF f[9];
    deformation_gradient(h, f);
    if constexpr (modes) {
      if constexpr (L::is_finite) add_cofactor_derivative<M>(f, p, moduli);
    } else {
      const ValueAndSlope<PackF> pressure = L::pressure(dilatation_of<L>(h), m);
      PackF area[9];
      cofactor_of<L>(h, area);
      if constexpr (L::is_finite) add_cofactor_derivative<M>(f, pressure.value, moduli);
      for (int r = 0; r < 9; ++r) {
        const PackF weighted = pressure.slope * area[r];
        for (int s = M::is_symmetric ? r : 0; s < 9; ++s) moduli[M::at(r, s)] += weighted * area[s];
      }
    }
  }
}

/// A cell's matrix: all of it, or the upper triangle.
template<class M>
struct CellMatrix {
  static constexpr bool is_symmetric = M::is_symmetric;
  static constexpr int n = is_symmetric ? n_upper : 24 * 24;
  static constexpr int at(int r, int s) { return is_symmetric ? upper(r, s) : 24 * r + s; }
  PackF entry[n];
};

/// matrix += grad N_a . moduli . grad N_b for all corners a, b.
template<class M>
SPRINGPROOF_INLINE void add_stiffness(const Cells& cells, int q, const PackF (&moduli)[M::n],
                                      CellMatrix<M>& matrix) {
  using K = CellMatrix<M>;
  float g[8][3];
  for (int a = 0; a < 8; ++a)
    for (int j = 0; j < 3; ++j) g[a][j] = static_cast<float>(cells.gradients[q][a][j]);
#pragma GCC unroll 1
  for (int b = 0; b < 8; ++b) {
    PackF right[9][3];
    for (int r = 0; r < 9; ++r)
      for (int k = 0; k < 3; ++k)
        right[r][k] = moduli[M::at(r, 3 * k)] * g[b][0] + moduli[M::at(r, 3 * k + 1)] * g[b][1] +
                      moduli[M::at(r, 3 * k + 2)] * g[b][2];
#pragma GCC unroll 1
    for (int a = 0; a < (K::is_symmetric ? b + 1 : 8); ++a)
      for (int i = 0; i < 3; ++i)
        for (int k = K::is_symmetric && a == b ? i : 0; k < 3; ++k)
          matrix.entry[K::at(3 * a + i, 3 * b + k)] +=
              right[3 * i][k] * g[a][0] + right[3 * i + 1][k] * g[a][1] + right[3 * i + 2][k] * g[a][2];
  }
}

/// Rows and columns of constrained degrees of freedom become 0.
SPRINGPROOF_INLINE void constrain(const Layout& layout, const float* free, std::ptrdiff_t node,
                                  PackF (&matrix)[n_upper]) {
  PackF mask[24], least = constant<PackF>(1);
  for (int a = 0; a < 8; ++a)
    for (int c = 0; c < 3; ++c) {
      mask[3 * a + c] = load(free + c * layout.size + node + corner_of(layout, a));
      least *= mask[3 * a + c];
    }
  if (all_greater(least, constant<PackF>(0.5))) return;
  for (int r = 0; r < 24; ++r)
    for (int s = r; s < 24; ++s) matrix[upper(r, s)] *= mask[r] * mask[s];
}

template<class K>
SPRINGPROOF_INLINE void add_masses(const Masses& masses, std::ptrdiff_t cell, K& matrix) {
  const PackF mass = narrow(load(masses.of_cell + cell), load(masses.of_cell + cell + pack_size<double>));
  for (int a = 0; a < 8; ++a)
    for (int b = K::is_symmetric ? a : 0; b < 8; ++b)
      for (int i = 0; i < 3; ++i)
        matrix.entry[K::at(3 * a + i, 3 * b + i)] += mass * static_cast<float>(masses.part[a][b]);
}

template<class L, bool modes>
void tangent_layer(const Cells& cells, const TangentFields& fields, const Coarsening& coarsening, int k) {
  using M = typename L::Moduli;
  using K = CellMatrix<M>;
  const Layout& layout = cells.layout;
  for (int j = 0; j < layout.nodes[1] - 1; ++j)
    for (int i = 0; i < layout.nodes[0] - 1; i += pack_size<float>) {
      const std::ptrdiff_t cell = layout.cell(i, j, k), node = layout.at(i, j, k);
      const PackF weight = load(cells.weight + cell);
      if (all_greater(constant<PackF>(1e-30), weight)) continue;
      Corners<PackD> low, high;
      Corners<PackF> u, volume_gradient{};
      load_corners(layout, fields.displacement, node, load_wide(cells.weight + cell), low);
      load_corners(layout, fields.displacement, node + pack_size<double>,
                   load_wide(cells.weight + cell + pack_size<double>), high);
      for (int a = 7; a >= 0; --a) // differences are what single precision can hold
        for (int c = 0; c < 3; ++c) u[a][c] = narrow(low[a][c] - low[0][c], high[a][c] - high[0][c]);
      const Parameters<PackF> m = parameters_of<PackF>(cells, cell);
      PackF p{};
      if constexpr (modes) {
        p = narrow(load(fields.pressure + cell), load(fields.pressure + cell + pack_size<double>));
        p = weight > PackF{} ? p : PackF{};
      }
      K matrix;
      for (int e = 0; e < K::n; ++e) matrix.entry[e] = PackF{};
#pragma GCC unroll 1
      for (int q = 0; q < 8; ++q) {
        PackF h[9], moduli[M::n];
        displacement_gradient(cells, q, u, h);
        moduli_of<L, modes>(h, p, m, moduli);
        add_stiffness<M>(cells, q, moduli, matrix);
        if constexpr (modes) {
          PackF area[9];
          cofactor_of<L>(h, area);
          add_divergence(cells, q, area, volume_gradient);
        }
      }
      if constexpr (modes) { // B^T C^-1 B
        const PackF inverse = 1 / (8 * L::dilatation(p, m).slope);
        for (int r = 0; r < 24; ++r) {
          const PackF weighted = inverse * volume_gradient[r / 3][r % 3];
          for (int s = K::is_symmetric ? r : 0; s < 24; ++s)
            matrix.entry[K::at(r, s)] += weighted * volume_gradient[s / 3][s % 3];
        }
      }
      const PackF scale = weight * static_cast<float>(cells.point_volume);
      for (int e = 0; e < K::n; ++e) matrix.entry[e] *= scale;
      if (fields.masses) add_masses(*fields.masses, cell, matrix);
      add_to_stencil(
          layout, [&](int r, int t) { return matrix.entry[K::at(r, t)]; }, fields.stencil, i, j, k);
      if (!fields.coarse) continue;
      PackF symmetric[n_upper];
      for (int r = 0; r < 24; ++r)
        for (int t = r; t < 24; ++t)
          symmetric[upper(r, t)] = (matrix.entry[K::at(r, t)] + matrix.entry[K::at(t, r)]) / 2;
      constrain(layout, fields.free, node, symmetric);
      add_to_coarse(symmetric, fields.coarse, coarsening, i, j, k);
    }
}

/// product += mass * field, cell by cell.
void mass_layer(const Layout& layout, const Masses& masses, const double* field, double* product, int k) {
  for (int j = 0; j < layout.nodes[1] - 1; ++j)
    for (int i = 0; i < layout.nodes[0] - 1; i += pack_size<double>) {
      const std::ptrdiff_t cell = layout.cell(i, j, k), node = layout.at(i, j, k);
      const PackD mass = load(masses.of_cell + cell);
      for (int c = 0; c < 3; ++c) {
        const std::ptrdiff_t first = c * layout.size + node;
        PackD value[8];
        for (int a = 0; a < 8; ++a) {
          value[a] = load(field + first + corner_of(layout, a));
          value[a] = mass > PackD{} ? value[a] : PackD{};
        }
        for (int a = 0; a < 8; ++a) {
          PackD sum{};
          for (int b = 0; b < 8; ++b) sum += value[b] * masses.part[a][b];
          add(product + first + corner_of(layout, a), mass * sum);
        }
      }
    }
}

// ---- one entry for all laws -------------------------------------------------------------------------------

/// Calls action(law, whether there are pressure modes).
template<class Action>
SPRINGPROOF_INLINE void with_modes(const Cells& cells, const Action& action) {
  with_law(cells.law, [&](auto law) {
    if constexpr (decltype(law)::has_pressure)
      if (cells.has_modes) return action(law, Count<1>{});
    action(law, Count<0>{});
  });
}

void force(const Cells& cells, const ForceFields& fields, int layer, Checks& checks) {
  with_modes(cells, [&](auto law, auto modes) {
    force_layer<decltype(law), decltype(modes)::value == 1>(cells, fields, layer, checks);
  });
}

void pressure_change(const Cells& cells, const ForceFields& fields, const double* step, double* change,
                     int layer) {
  with_modes(cells, [&](auto law, auto modes) {
    if constexpr (decltype(modes)::value == 1)
      pressure_change_layer<decltype(law)>(cells, fields, step, change, layer);
  });
}

void tangent(const Cells& cells, const TangentFields& fields, const Coarsening& coarsening, int layer) {
  with_modes(cells, [&](auto law, auto modes) {
    tangent_layer<decltype(law), decltype(modes)::value == 1>(cells, fields, coarsening, layer);
  });
}
