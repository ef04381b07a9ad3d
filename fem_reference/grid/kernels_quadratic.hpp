// Part of kernels_source.hpp, in its namespace: triquadratic elements. Their nodes are those of trilinear
// elements of half the edge: node (a, b, c) of cell (I, J, K) is node (2I + a, 2J + b, 2K + c) of the grid.
#pragma once

template<class P>
using Nodes = P[27][3];

SPRINGPROOF_INLINE std::ptrdiff_t quadratic_node(const Layout& layout, int a) {
  return a % 3 + a / 3 % 3 * layout.row + a / 9 * layout.plane;
}

/// Loads every second number.
SPRINGPROOF_INLINE PackD load_second(const double* from) {
  PackD result;
  for (int l = 0; l < pack_size<double>; ++l) result[l] = from[2 * l];
  return result;
}

SPRINGPROOF_INLINE void load_nodes(const Layout& layout, const double* field, std::ptrdiff_t first,
                                   const PackD& weight, Nodes<PackD>& u) {
  for (int a = 0; a < 27; ++a)
    for (int c = 0; c < 3; ++c) {
      const PackD value = load_second(field + c * layout.size + first + quadratic_node(layout, a));
      u[a][c] = weight > PackD{} ? value : PackD{};
    }
}
/// Loads differences to the lowest node, which single precision can hold.
SPRINGPROOF_INLINE void load_differences(const Quadratic& elements, const double* field, std::ptrdiff_t cell,
                                         std::ptrdiff_t first, Nodes<PackF>& u) {
  const Layout& layout = elements.nodes;
  Nodes<PackD> low, high;
  const float* weight = elements.cells.weight + cell;
  load_nodes(layout, field, first, load_wide(weight), low);
  load_nodes(layout, field, first + 2 * pack_size<double>, load_wide(weight + pack_size<double>), high);
  for (int a = 0; a < 27; ++a)
    for (int c = 0; c < 3; ++c) u[a][c] = narrow(low[a][c] - low[0][c], high[a][c] - high[0][c]);
}

template<class P>
SPRINGPROOF_INLINE void quadratic_gradient(const Quadratic& elements, int q, const Nodes<P>& u, P (&h)[9]) {
  using Real = RealOf<P>;
  for (int e = 0; e < 9; ++e) h[e] = P{};
#pragma GCC unroll 3
  for (int a = 0; a < 27; ++a)
    for (int j = 0; j < 3; ++j) {
      const Real g = static_cast<Real>(elements.gradients[q][a][j]);
      for (int i = 0; i < 3; ++i) h[3 * i + j] += u[a][i] * g;
    }
}

template<class P>
SPRINGPROOF_INLINE void add_quadratic_divergence(const Quadratic& elements, int q, const P (&stress)[9],
                                                 Nodes<P>& force) {
  using Real = RealOf<P>;
#pragma GCC unroll 3
  for (int a = 0; a < 27; ++a) {
    const Real x = static_cast<Real>(elements.gradients[q][a][0]),
               y = static_cast<Real>(elements.gradients[q][a][1]),
               z = static_cast<Real>(elements.gradients[q][a][2]);
    for (int i = 0; i < 3; ++i)
      force[a][i] += stress[3 * i] * x + stress[3 * i + 1] * y + stress[3 * i + 2] * z;
  }
}

/// Adds to every second number of a field.
template<class P>
SPRINGPROOF_INLINE void scatter(const Layout& layout, const Nodes<P>& force, std::ptrdiff_t first, int n,
                                double* field) {
  for (int a = 0; a < 27; ++a)
    for (int c = 0; c < 3; ++c) {
      double* const to = field + c * layout.size + first + quadratic_node(layout, a);
      for (int l = 0; l < n; ++l) to[2 * l] += static_cast<double>(force[a][c][l]);
    }
}

template<class L>
void quadratic_force_layer(const Quadratic& elements, const ForceFields& fields, int k, Checks& checks) {
  const Layout &nodes = elements.nodes, &cells = elements.cells.layout;
  const int n = cells.nodes[0] - 1;
  for (int j = 0; j < cells.nodes[1] - 1; ++j)
    for (int i = 0; i < n; i += pack_size<double>) {
      const std::ptrdiff_t cell = cells.cell(i, j, k), first = nodes.at(2 * i, 2 * j, 2 * k);
      const PackD weight = load_wide(elements.cells.weight + cell);
      Nodes<PackD> u, force{};
      load_nodes(nodes, fields.displacement, first, weight, u);
      const Parameters<PackD> m = parameters_of<PackD>(elements.cells, cell);
      PackD volume{}, lowest{};
#pragma GCC unroll 1
      for (int q = 0; q < 27; ++q) {
        PackD h[9], stress[9];
        quadratic_gradient(elements, q, u, h);
        const PackD dilatation = dilatation_of<L>(h);
        lowest = dilatation > lowest ? lowest : dilatation; // keeps what is not a number
        stress_of<L>(h, m, stress);
        const PackD scale = weight * elements.weights[q];
        for (int e = 0; e < 9; ++e) stress[e] *= scale;
        add_quadratic_divergence(elements, q, stress, force);
        if (fields.volume) volume += (1 + (L::is_finite ? dilatation : growth_of(h))) * scale;
      }
      const PackD least = constant<PackD>(L::is_finite ? -1 : -1e100);
      if (!all_greater(lowest, least)) {
        checks.valid = false;
        return;
      }
      if (fields.volume) store(fields.volume + cell, volume);
      if (fields.force)
        scatter(nodes, force, first, n - i < pack_size<double> ? n - i : pack_size<double>, fields.force);
    }
}

/// Place of a row's moduli: [point][entry][i].
template<class M>
SPRINGPROOF_INLINE std::ptrdiff_t moduli_row(const Layout& cells, int j, int k) {
  return cells.row * M::n * 27 * (j + std::ptrdiff_t{cells.nodes[1] - 1} * k);
}

template<class L>
void quadratic_moduli_layer(const Quadratic& elements, const double* displacement, float* all, int k) {
  using M = typename L::Moduli;
  const Layout &nodes = elements.nodes, &cells = elements.cells.layout;
  for (int j = 0; j < cells.nodes[1] - 1; ++j)
    for (int i = 0; i < cells.nodes[0] - 1; i += pack_size<float>) {
      const std::ptrdiff_t cell = cells.cell(i, j, k);
      Nodes<PackF> u;
      load_differences(elements, displacement, cell, nodes.at(2 * i, 2 * j, 2 * k), u);
      const Parameters<PackF> m = parameters_of<PackF>(elements.cells, cell);
      const PackF weight = load(elements.cells.weight + cell);
      float* to = all + moduli_row<M>(cells, j, k) + i;
#pragma GCC unroll 1
      for (int q = 0; q < 27; ++q) {
        PackF h[9], moduli[M::n];
        quadratic_gradient(elements, q, u, h);
        moduli_of<L, false>(h, PackF{}, m, moduli);
        const PackF scale = weight * static_cast<float>(elements.weights[q]);
        for (int e = 0; e < M::n; ++e, to += cells.row) store(to, scale * moduli[e]);
      }
    }
}

template<class M>
void quadratic_product_layer(const Quadratic& elements, const float* all, const double* field,
                             double* product, int k) {
  const Layout &nodes = elements.nodes, &cells = elements.cells.layout;
  const int n = cells.nodes[0] - 1;
  for (int j = 0; j < cells.nodes[1] - 1; ++j)
    for (int i = 0; i < n; i += pack_size<float>) {
      const std::ptrdiff_t first = nodes.at(2 * i, 2 * j, 2 * k);
      Nodes<PackF> u, force{};
      load_differences(elements, field, cells.cell(i, j, k), first, u);
      const float* from = all + moduli_row<M>(cells, j, k) + i;
#pragma GCC unroll 1
      for (int q = 0; q < 27; ++q, from += M::n * cells.row) {
        PackF h[9], stress[9];
        quadratic_gradient(elements, q, u, h);
        for (int r = 0; r < 9; ++r) {
          PackF sum{};
          for (int s = 0; s < 9; ++s) sum += load(from + M::at(r, s) * cells.row) * h[s];
          stress[r] = sum;
        }
        add_quadratic_divergence(elements, q, stress, force);
      }
      scatter(nodes, force, first, n - i < pack_size<float> ? n - i : pack_size<float>, product);
    }
}

// ---- one entry for all laws -------------------------------------------------------------------------------

void quadratic_force(const Quadratic& elements, const ForceFields& fields, int layer, Checks& checks) {
  with_law(elements.cells.law,
           [&](auto law) { quadratic_force_layer<decltype(law)>(elements, fields, layer, checks); });
}
void quadratic_moduli(const Quadratic& elements, const double* displacement, float* moduli, int layer) {
  with_law(elements.cells.law,
           [&](auto law) { quadratic_moduli_layer<decltype(law)>(elements, displacement, moduli, layer); });
}
void quadratic_product(const Quadratic& elements, const float* moduli, const double* field, double* product,
                       int layer) {
  with_law(elements.cells.law, [&](auto law) {
    quadratic_product_layer<typename decltype(law)::Moduli>(elements, moduli, field, product, layer);
  });
}
