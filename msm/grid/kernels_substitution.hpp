// Part of kernels_source.hpp, in its namespace: substitutions in a factor.
#pragma once

/// to = a panel times from, one number per column.
template<int rows>
SPRINGPROOF_INLINE const std::int16_t* times(const std::int16_t* panel, int n_columns, const float* from,
                                             float* to) {
  constexpr std::ptrdiff_t lanes = pack_size<float>, n = rows / lanes;
  constexpr std::ptrdiff_t ahead = 32 * panel_rows; // after a pause a factor comes from memory
  PackF sum[n] = {};
  for (int j = 0; j < n_columns; ++j, panel += rows) {
    __builtin_prefetch(panel + ahead);
    const PackF x = PackF{} + from[j];
    for (std::ptrdiff_t p = 0; p < n; ++p) sum[p] += load(panel + p * lanes) * x;
  }
  for (std::ptrdiff_t p = 0; p < n; ++p) store(to + p * lanes, sum[p]);
  return panel;
}

/// to += the transposed of a panel times from, one pack per column, whose numbers are to be added up.
template<int rows>
SPRINGPROOF_INLINE const std::int16_t* times_transposed(const std::int16_t* panel, int n_columns,
                                                        const float* from, float* to) {
  constexpr std::ptrdiff_t lanes = pack_size<float>, n = rows / lanes;
  PackF x[n];
  for (std::ptrdiff_t p = 0; p < n; ++p) x[p] = load(from + p * lanes);
  for (int j = 0; j < n_columns; ++j, panel += rows, to += lanes) {
    PackF sum = load(to);
    for (std::ptrdiff_t p = 0; p < n; ++p) sum += load(panel + p * lanes) * x[p];
    store(to, sum);
  }
  return panel;
}

/// x = (L L^T)^-1 x, one block after the other and back.
void substitute(const BlockFactor& factor, float* x, float* scratch) {
  constexpr std::ptrdiff_t lanes = pack_size<float>;
  for (int b = 0; b < factor.n_blocks; ++b) {
    const FactorBlock& columns = factor.blocks[b];
    const int m = columns.n_columns, n = padded(m + columns.n_below);
    float *own = x + columns.first, *found = scratch, *in_steps = scratch + n;
    for (std::ptrdiff_t j = 0; j < m; j += lanes)
      store(in_steps + j, load(columns.steps + j) * load(own + j));
    const std::int16_t* panel = columns.values;
    for (int r = 0; r < n; r += panel_rows)
      panel = r + panel_rows <= n ? times<panel_rows>(panel, m, in_steps, found + r)
                                  : times<16>(panel, m, in_steps, found + r);
    __builtin_memcpy(own, found, static_cast<std::size_t>(m) * sizeof(float));
    const float* below = found + m;
    for (int r = 0; r < columns.n_below; ++r) x[columns.rows[r]] -= columns.below * below[r];
  }
  for (int b = factor.n_blocks - 1; b >= 0; --b) {
    const FactorBlock& columns = factor.blocks[b];
    const int m = columns.n_columns, n = padded(m + columns.n_below);
    float *own = x + columns.first, *gathered = scratch, *sums = scratch + n;
    for (std::ptrdiff_t j = 0; j < m; j += lanes) store(gathered + j, load(own + j));
    for (int r = 0; r < columns.n_below; ++r) gathered[m + r] = -columns.below * x[columns.rows[r]];
    for (int r = m + columns.n_below; r < n; ++r) gathered[r] = 0;
    for (std::ptrdiff_t j = 0; j < m; ++j) store(sums + j * lanes, PackF{});
    const std::int16_t* panel = columns.values;
    for (int r = 0; r < n; r += panel_rows)
      panel = r + panel_rows <= n ? times_transposed<panel_rows>(panel, m, gathered + r, sums)
                                  : times_transposed<16>(panel, m, gathered + r, sums);
    for (int j = 0; j < m; ++j) {
      float sum = 0;
      for (std::ptrdiff_t lane = 0; lane < lanes; ++lane) sum += sums[j * lanes + lane];
      own[j] = columns.steps[j] * sum;
    }
  }
}
