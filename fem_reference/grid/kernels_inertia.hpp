// Part of kernels_source.hpp, in its namespace: masses of cells.
#pragma once

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
