// Part of kernels_source.hpp, which is compiled once per instruction set.

// ---- substitutions in a factor
// ------------------------------------------------------------------------------

/// to = the sum over columns of matrix[:, j] * from[j].
SPRINGPROOF_INLINE void times(const float* __restrict matrix, int n_rows, int n_columns,
                              const float* __restrict from, float* __restrict to) {
  for (int r = 0; r < n_rows; ++r) to[r] = 0;
  int j = 0;
  for (; j + 4 <= n_columns; j += 4) {
    const float *a = matrix + std::ptrdiff_t{j} * n_rows, *b = a + n_rows, *c = b + n_rows, *d = c + n_rows;
    const float x = from[j], y = from[j + 1], z = from[j + 2], w = from[j + 3];
    for (int r = 0; r < n_rows; ++r) to[r] += a[r] * x + b[r] * y + c[r] * z + d[r] * w;
  }
  for (; j < n_columns; ++j) {
    const float* a = matrix + std::ptrdiff_t{j} * n_rows;
    for (int r = 0; r < n_rows; ++r) to[r] += a[r] * from[j];
  }
}

/// to[j] = the sum over rows of matrix[:, j] * from.
SPRINGPROOF_INLINE void times_transposed(const float* __restrict matrix, int n_rows, int n_columns,
                                         const float* __restrict from, float* __restrict to) {
  int j = 0;
  for (; j + 4 <= n_columns; j += 4) {
    const float *a = matrix + std::ptrdiff_t{j} * n_rows, *b = a + n_rows, *c = b + n_rows, *d = c + n_rows;
    float x = 0, y = 0, z = 0, w = 0;
    for (int r = 0; r < n_rows; ++r) {
      const float f = from[r];
      x += a[r] * f, y += b[r] * f, z += c[r] * f, w += d[r] * f;
    }
    to[j] = x, to[j + 1] = y, to[j + 2] = z, to[j + 3] = w;
  }
  for (; j < n_columns; ++j) {
    const float* a = matrix + std::ptrdiff_t{j} * n_rows;
    float x = 0;
    for (int r = 0; r < n_rows; ++r) x += a[r] * from[r];
    to[j] = x;
  }
}

/// x = (L L^T)^-1 x, one block after the other and back.
void substitute(const BlockFactor& factor, float* x, float* scratch) {
  for (int b = 0; b < factor.n_blocks; ++b) {
    const FactorBlock& columns = factor.blocks[b];
    const int m = columns.n_columns, below = columns.n_below, n_own = padded(m), n_below = padded(below);
    float* own = x + columns.first;
    const float *inverse = columns.values, *rest = inverse + std::ptrdiff_t{n_own} * m;
    times(inverse, n_own, m, own, scratch);
    for (int j = 0; j < m; ++j) own[j] = scratch[j];
    times(rest, n_below, m, own, scratch);
    for (int r = 0; r < below; ++r) x[columns.rows[r]] -= scratch[r];
  }
  for (int b = factor.n_blocks - 1; b >= 0; --b) {
    const FactorBlock& columns = factor.blocks[b];
    const int m = columns.n_columns, below = columns.n_below, n_own = padded(m), n_below = padded(below);
    float* own = x + columns.first;
    const float *inverse = columns.values, *rest = inverse + std::ptrdiff_t{n_own} * m;
    float *gathered = scratch, *found = scratch + n_below;
    for (int r = 0; r < below; ++r) gathered[r] = x[columns.rows[r]];
    for (int r = below; r < n_below; ++r) gathered[r] = 0;
    times_transposed(rest, n_below, m, gathered, found);
    for (int j = 0; j < m; ++j) own[j] -= found[j];
    for (int j = 0; j < m; ++j) scratch[j] = own[j];
    for (int j = m; j < n_own; ++j) scratch[j] = 0;
    times_transposed(inverse, n_own, m, scratch, own);
  }
}
