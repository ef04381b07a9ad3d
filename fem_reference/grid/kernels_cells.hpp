// Part of kernels_source.hpp, in its namespace: forces and tangents of layers of cells.
#pragma once

template<class L, Internal internal>
void force_layer(const Cells& cells, const ForceFields& fields, int k, Checks& checks) {
  constexpr bool modes = internal == Internal::pressure, bubbles = internal == Internal::bubbles;
  using M = typename L::Moduli;
  const Layout& layout = cells.layout;
  PackD mismatch{}, imbalance{};
  for (int j = 0; j < layout.nodes[1] - 1; ++j)
    for (int i = 0; i < layout.nodes[0] - 1; i += pack_size<double>) {
      const std::ptrdiff_t cell = layout.cell(i, j, k), node = layout.at(i, j, k);
      const PackD weight = load_wide(cells.weight + cell);
      if (!all_greater(weight, constant<PackD>(-1)) || all_greater(constant<PackD>(1e-30), weight)) continue;
      Corners<PackD> u, force{}, volume_gradient{};
      load_corners(layout, fields.displacement, node, weight, u);
      const Parameters<PackD> m = parameters_of<PackD>(cells, cell);
      PackD own[bubbles ? 9 : 1] = {}, growth{}, volume{}, lowest{};
      load_internal<n_fields(internal)>(cells, fields.internal, cell, weight, own);
      const PackD& p = own[0];
      ValueAndSlope<PackD> target{};
      if constexpr (modes) target = L::dilatation(p, m);
      Bubbles<PackD> on_bubbles{};
      BubbleStiffness<PackD> stiffness;
#pragma GCC unroll 1
      for (int q = 0; q < 8; ++q) {
        PackD h[9], stress[9];
        displacement_gradient(cells, q, u, h);
        if (fields.volume) volume += 1 + growth_of(h);
        if constexpr (bubbles) add_bubble_gradient(cells, q, own, h);
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
        if constexpr (bubbles) {
          add_bubble_force(cells, q, stress, on_bubbles);
          if (!fields.condensed) continue;
          PackD moduli[M::n];
          moduli_of<L, false>(h, PackD{}, m, moduli);
          add_own<M>(cells, q, moduli, stiffness.own);
          add_coupling<M, Coupling::on_corners>(cells, q, moduli, stiffness.on_corners);
        }
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
      if constexpr (bubbles) {
        for (const PackD& f : on_bubbles) imbalance += scale * f * (scale * f);
        if (fields.condensed) {
          factorise(stiffness.own);
          solve(stiffness.own, on_bubbles);
        }
      }
      if (fields.volume)
        store(fields.volume + cell, weight > PackD{} ? volume * cells.point_volume : PackD{});
      for (int a = 0; a < 8; ++a)
        for (int c = 0; c < 3; ++c) {
          const std::ptrdiff_t at = c * layout.size + node + corner_of(layout, a);
          if (fields.force) add(fields.force + at, scale * force[a][c]);
          if (!fields.condensed) continue;
          PackD condensed = force[a][c] + change * volume_gradient[a][c];
          for (int b = 0; bubbles && b < 9; ++b) condensed -= stiffness.on_corners[a][c][b] * on_bubbles[b];
          add(fields.condensed + at, scale * condensed);
        }
    }
  for (int l = 0; l < pack_size<double>; ++l) {
    if (mismatch[l] > checks.volume_mismatch) checks.volume_mismatch = mismatch[l];
    checks.bubble_imbalance += imbalance[l];
  }
}

/// Replaces a cell's pressure by its change with the step du.
template<class L>
SPRINGPROOF_INLINE void pressure_change(const Cells& cells, const Corners<PackD>& u, const Corners<PackD>& du,
                                        const Parameters<PackD>& m, PackD& p) {
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
  p = (growth / 8 - target.value) / target.slope;
}

/// Replaces a cell's bubbles by their change with the step du.
template<class L, class M = typename L::Moduli>
SPRINGPROOF_INLINE void bubble_change(const Cells& cells, const Corners<PackD>& u, const Corners<PackD>& du,
                                      const Parameters<PackD>& m, Bubbles<PackD>& bubbles) {
  Bubbles<PackD> force{};
  PackD stiffness[9][9] = {};
#pragma GCC unroll 1
  for (int q = 0; q < 8; ++q) {
    PackD h[9], dh[9], stress[9], moduli[M::n];
    displacement_gradient(cells, q, u, h);
    displacement_gradient(cells, q, du, dh);
    add_bubble_gradient(cells, q, bubbles, h);
    stress_of<L>(h, m, stress);
    moduli_of<L, false>(h, PackD{}, m, moduli);
    for (int r = 0; r < 9; ++r)
      for (int s = 0; s < 9; ++s) stress[r] += moduli[M::at(r, s)] * dh[s];
    add_bubble_force(cells, q, stress, force);
    add_own<M>(cells, q, moduli, stiffness);
  }
  factorise(stiffness);
  solve(stiffness, force);
  for (int b = 0; b < 9; ++b) bubbles[b] = -force[b];
}

template<class L, Internal internal>
void internal_change_layer(const Cells& cells, const ForceFields& fields, const double* step, double* change,
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
      PackD own[n_fields(internal)];
      load_internal<n_fields(internal)>(cells, fields.internal, cell, weight, own);
      if constexpr (internal == Internal::pressure)
        pressure_change<L>(cells, u, du, m, own[0]);
      else
        bubble_change<L>(cells, u, du, m, own);
      for (int e = 0; e < n_fields(internal); ++e)
        store(change + e * layout.n_cell_entries() + cell, weight > PackD{} ? own[e] : PackD{});
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

/// matrix -= on_corners K_bb^-1 on_bubbles^T. The bubbles' own stiffness is replaced by its factors.
template<class K>
SPRINGPROOF_INLINE void condense(BubbleStiffness<PackF>& stiffness, const PackF (&on_bubbles)[8][3][9],
                                 K& matrix) {
  factorise(stiffness.own);
#pragma GCC unroll 1
  for (int s = 0; s < 24; ++s) {
    Bubbles<PackF> x;
    for (int b = 0; b < 9; ++b) x[b] = on_bubbles[s / 3][s % 3][b];
    solve(stiffness.own, x);
#pragma GCC unroll 1
    for (int r = 0; r < (K::is_symmetric ? s + 1 : 24); ++r)
      for (int b = 0; b < 9; ++b) matrix.entry[K::at(r, s)] -= stiffness.on_corners[r / 3][r % 3][b] * x[b];
  }
}

template<class K>
SPRINGPROOF_INLINE void add_masses(const Masses<double>& masses, std::ptrdiff_t cell, K& matrix) {
  const PackF mass = narrow(load(masses.of_cell + cell), load(masses.of_cell + cell + pack_size<double>));
  for (int a = 0; a < 8; ++a)
    for (int b = K::is_symmetric ? a : 0; b < 8; ++b) {
      const double consistent = (8 >> __builtin_popcount(static_cast<unsigned>(a ^ b))) / 216.;
      const double part = masses.consistent * consistent + (a == b ? masses.lumped / 8 : 0);
      for (int i = 0; i < 3; ++i)
        matrix.entry[K::at(3 * a + i, 3 * b + i)] += mass * static_cast<float>(part);
    }
}

template<class L, Internal internal>
void tangent_layer(const Cells& cells, const TangentFields& fields, const Coarsening& coarsening, int k) {
  constexpr bool modes = internal == Internal::pressure, bubbles = internal == Internal::bubbles;
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
      PackF own[bubbles ? 9 : 1] = {}, on_bubbles[8][3][9] = {};
      load_internal<n_fields(internal)>(cells, fields.internal, cell, weight, own);
      const PackF& p = own[0];
      BubbleStiffness<PackF> stiffness;
      K matrix;
      for (int e = 0; e < K::n; ++e) matrix.entry[e] = PackF{};
#pragma GCC unroll 1
      for (int q = 0; q < 8; ++q) {
        PackF h[9], moduli[M::n];
        displacement_gradient(cells, q, u, h);
        if constexpr (bubbles) add_bubble_gradient(cells, q, own, h);
        moduli_of<L, modes>(h, p, m, moduli);
        add_stiffness<M>(cells, q, moduli, matrix);
        if constexpr (bubbles) {
          add_own<M>(cells, q, moduli, stiffness.own);
          add_coupling<M, Coupling::on_corners>(cells, q, moduli, stiffness.on_corners);
          if (!M::is_symmetric) add_coupling<M, Coupling::on_bubbles>(cells, q, moduli, on_bubbles);
        }
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
      if constexpr (bubbles) condense(stiffness, M::is_symmetric ? stiffness.on_corners : on_bubbles, matrix);
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

// ---- one entry for all laws -------------------------------------------------------------------------------

/// What cells have of their own, as a type.
template<Internal of_cells>
struct Unknowns {
  static constexpr Internal internal = of_cells;
};
/// Calls action(law, its Unknowns).
template<class Action>
SPRINGPROOF_INLINE void with_unknowns(const Cells& cells, const Action& action) {
  with_law(cells.law, [&](auto law) {
    if constexpr (decltype(law)::has_pressure)
      if (cells.internal == Internal::pressure) return action(law, Unknowns<Internal::pressure>{});
    if (cells.internal == Internal::bubbles) return action(law, Unknowns<Internal::bubbles>{});
    action(law, Unknowns<Internal::none>{});
  });
}

void force(const Cells& cells, const ForceFields& fields, int layer, Checks& checks) {
  with_unknowns(cells, [&](auto law, auto unknowns) {
    force_layer<decltype(law), decltype(unknowns)::internal>(cells, fields, layer, checks);
  });
}

void internal_change(const Cells& cells, const ForceFields& fields, const double* step, double* change,
                     int layer) {
  with_unknowns(cells, [&](auto law, auto unknowns) {
    constexpr Internal internal = decltype(unknowns)::internal;
    if constexpr (internal != Internal::none)
      internal_change_layer<decltype(law), internal>(cells, fields, step, change, layer);
  });
}

void tangent(const Cells& cells, const TangentFields& fields, const Coarsening& coarsening, int layer) {
  with_unknowns(cells, [&](auto law, auto unknowns) {
    tangent_layer<decltype(law), decltype(unknowns)::internal>(cells, fields, coarsening, layer);
  });
}
