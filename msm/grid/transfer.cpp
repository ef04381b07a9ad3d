#include "msm/grid/transfer.hpp"

namespace springproof::msm::grid {

namespace {

/// Rows that a row is made from, along one axis, and their weights.
struct Stencil {
  int n;
  int at[3];
  double weight[3];
};

Stencil interpolate_from(int i, bool is_coarsened) {
  if (!is_coarsened) return {1, {i}, {1}};
  if (i % 2 == 0) return {1, {i / 2}, {1}};
  return {2, {i / 2, i / 2 + 1}, {0.5, 0.5}};
}

Stencil restrict_from(int i, bool is_coarsened) {
  if (!is_coarsened) return {1, {i}, {1}};
  return {3, {2 * i - 1, 2 * i, 2 * i + 1}, {0.5, 1, 0.5}};
}

/// Every row of a result: weighted rows of the source, over what the stencils select along y and z, then
/// along_x(that row, row of the result).
template<class Real, class AlongX>
void transfer_rows(const Layout& from, const Field<Real>& source, const Layout& to, Field<Real>& result,
                   Stencil (*stencil)(int, bool), const bool (&is_coarsened)[3], int n_threads,
                   const AlongX& along_x) {
  for_each_plane(to, n_threads, [&](int k) {
    const Stencil z = stencil(k, is_coarsened[2]);
    // One ghost before, and two after for coarse cells that reach beyond the body.
    Field<Real> sum(from.nodes[0] + 4);
    for (int component = 0; component < 3; ++component)
      for (int j = 0; j < to.nodes[1]; ++j) {
        const Stencil y = stencil(j, is_coarsened[1]);
        sum.setZero();
        for (int c = 0; c < z.n; ++c)
          for (int b = 0; b < y.n; ++b) {
            if (y.at[b] < 0 || y.at[b] >= from.nodes[1] || z.at[c] < 0 || z.at[c] >= from.nodes[2]) continue;
            sum.segment(1, from.nodes[0]) +=
                static_cast<Real>(y.weight[b] * z.weight[c]) *
                source.segment(from.at(0, y.at[b], z.at[c], component), from.nodes[0]);
          }
        const Real* in = sum.data() + 1;
        Real* out = result.data() + to.at(0, j, k, component);
        if (is_coarsened[0])
          along_x(in, out);
        else
          std::copy(in, in + to.nodes[0], out);
      }
  });
}

} // namespace

template<class Real>
Transfer<Real>::Transfer(const Body& fine, const Body& coarse, int n_threads)
    : fine_(fine), coarse_(coarse), n_threads_(n_threads) {
  for (std::size_t a = 0; a < 3; ++a) is_coarsened_[a] = coarse.cells[a] != fine.cells[a];
}

template<class Real>
void Transfer<Real>::prolong(const Field<Real>& coarse, Field<Real>& fine) const {
  const int n = fine_.layout.nodes[0];
  transfer_rows(coarse_.layout, coarse, fine_.layout, fine, interpolate_from, is_coarsened_, n_threads_,
                [n](const Real* in, Real* out) {
                  for (int i = 0; i < n; i += 2) out[i] = in[i / 2];
                  for (int i = 1; i < n; i += 2) out[i] = Real(0.5) * (in[i / 2] + in[i / 2 + 1]);
                });
  clear_constrained(fine_, fine);
}

template<class Real>
void Transfer<Real>::restrict(const Field<Real>& fine, Field<Real>& coarse) const {
  const int n = coarse_.layout.nodes[0];
  transfer_rows(fine_.layout, fine, coarse_.layout, coarse, restrict_from, is_coarsened_, n_threads_,
                [n](const Real* in, Real* out) {
                  for (int i = 0; i < n; ++i)
                    out[i] = in[2 * i] + Real(0.5) * (in[2 * i - 1] + in[2 * i + 1]);
                });
  clear_constrained(coarse_, coarse);
}

template<class Real>
void Transfer<Real>::sample(const Field<Real>& fine, Field<Real>& coarse) const {
  const Layout &from = fine_.layout, &to = coarse_.layout;
  const auto around = [&](int component, const int(&node)[3]) {
    const auto& [i, j, k] = node;
    if (has_cell(fine_, i, j, k)) return fine[from.at(i, j, k, component)];
    Real sum = 0;
    int n = 0;
    for (int c = std::max(k - 1, 0); c <= std::min(k + 1, fine_.cells[2]); ++c)
      for (int b = std::max(j - 1, 0); b <= std::min(j + 1, fine_.cells[1]); ++b)
        for (int a = std::max(i - 1, 0); a <= std::min(i + 1, fine_.cells[0]); ++a)
          if (has_cell(fine_, a, b, c)) {
            sum += fine[from.at(a, b, c, component)];
            ++n;
          }
    return n > 0 ? sum / static_cast<Real>(n) : Real(0);
  };
  for_each_plane(to, n_threads_, [&](int k) {
    for (int j = 0; j < to.nodes[1]; ++j)
      for (int i = 0; i < to.nodes[0]; ++i) {
        const int node[3] = {i, j, k};
        int inside[3], before[3];
        bool beyond = false;
        for (std::size_t a = 0; a < 3; ++a) {
          const int on_fine = is_coarsened_[a] ? 2 * node[a] : node[a];
          inside[a] = std::min(on_fine, fine_.cells[a]);
          before[a] = inside[a] - (on_fine - inside[a]);
          beyond = beyond || before[a] != inside[a];
        }
        for (int component = 0; component < 3; ++component) {
          Real at = around(component, inside);
          if (beyond) at += at - around(component, before);
          coarse[to.at(i, j, k, component)] = at;
        }
      }
  });
  // Held nodes may lie beyond the body: they keep what was extrapolated, being no unknowns.
}

template class Transfer<double>;
template class Transfer<float>;

} // namespace springproof::msm::grid
