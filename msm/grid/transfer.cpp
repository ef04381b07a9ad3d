#include "msm/grid/transfer.hpp"

#include <vector>

namespace springproof::msm::grid {

namespace {

/// Rows that a row is made from, along one axis, and their weights.
struct Stencil {
  int n;
  int at[3];
  double weight[3];
};

Stencil interpolate_from(int i, bool coarsened) {
  if (!coarsened) return {1, {i}, {1}};
  if (i % 2 == 0) return {1, {i / 2}, {1}};
  return {2, {i / 2, i / 2 + 1}, {0.5, 0.5}};
}

Stencil restrict_from(int i, bool coarsened) {
  if (!coarsened) return {1, {i}, {1}};
  return {3, {2 * i - 1, 2 * i, 2 * i + 1}, {0.5, 1, 0.5}};
}

/// sum = weighted rows of a source, over what two stencils select.
template<class Real>
void gather_rows(const Layout& layout, const Real* source, const Stencil& y, const Stencil& z,
                 std::vector<Real>& sum) {
  std::fill(sum.begin(), sum.end(), Real(0));
  for (int c = 0; c < z.n; ++c)
    for (int b = 0; b < y.n; ++b) {
      if (y.at[b] < 0 || y.at[b] >= layout.nodes[1] || z.at[c] < 0 || z.at[c] >= layout.nodes[2]) continue;
      const Real weight = static_cast<Real>(y.weight[b] * z.weight[c]);
      const Real* row = source + layout.at(0, y.at[b], z.at[c]);
      for (int i = 0; i < layout.nodes[0]; ++i) sum[static_cast<std::size_t>(i + 1)] += weight * row[i];
    }
}

} // namespace

template<class Real>
void Transfer<Real>::prolong(const Field<Real>& coarse, Field<Real>& fine) const {
  const Layout &from = coarse_.layout, &to = fine_.layout;
#pragma omp parallel for num_threads(n_threads_)                                                             \
    schedule(static) if (n_threads_ > 1 && fine_.layout.size > piece)
  for (int k = 0; k < to.nodes[2]; ++k) {
    std::vector<Real> row(static_cast<std::size_t>(from.nodes[0] + 2));
    for (int component = 0; component < 3; ++component)
      for (int j = 0; j < to.nodes[1]; ++j) {
        gather_rows(from, coarse.data() + component * from.size, interpolate_from(j, axes_[1]),
                    interpolate_from(k, axes_[2]), row);
        Real* out = fine.data() + component * to.size + to.at(0, j, k);
        const Real* in = row.data() + 1;
        if (!axes_[0])
          for (int i = 0; i < to.nodes[0]; ++i) out[i] = in[i];
        else {
          for (int i = 0; i < to.nodes[0]; i += 2) out[i] = in[i / 2];
          for (int i = 1; i < to.nodes[0]; i += 2) out[i] = Real(0.5) * (in[i / 2] + in[i / 2 + 1]);
        }
      }
  }
  clear_constrained(fine_, fine);
}

template<class Real>
void Transfer<Real>::restrict(const Field<Real>& fine, Field<Real>& coarse) const {
  const Layout &from = fine_.layout, &to = coarse_.layout;
#pragma omp parallel for num_threads(n_threads_)                                                             \
    schedule(static) if (n_threads_ > 1 && fine_.layout.size > piece)
  for (int k = 0; k < to.nodes[2]; ++k) {
    // One ghost before, and two after for coarse cells that reach beyond the body.
    std::vector<Real> row(static_cast<std::size_t>(from.nodes[0] + 4));
    for (int component = 0; component < 3; ++component)
      for (int j = 0; j < to.nodes[1]; ++j) {
        gather_rows(from, fine.data() + component * from.size, restrict_from(j, axes_[1]),
                    restrict_from(k, axes_[2]), row);
        Real* out = coarse.data() + component * to.size + to.at(0, j, k);
        const Real* in = row.data() + 1;
        if (!axes_[0])
          for (int i = 0; i < to.nodes[0]; ++i) out[i] = in[i];
        else
          for (int i = 0; i < to.nodes[0]; ++i)
            out[i] = in[2 * i] + Real(0.5) * (in[2 * i - 1] + in[2 * i + 1]);
      }
  }
  clear_constrained(coarse_, coarse);
}

template<class Real>
void Transfer<Real>::sample(const Field<Real>& fine, Field<Real>& coarse) const {
  const Layout &from = fine_.layout, &to = coarse_.layout;
  const int factor[3] = {axes_[0] ? 2 : 1, axes_[1] ? 2 : 1, axes_[2] ? 2 : 1};
  const auto value = [&](int component, int i, int j, int k) {
    return fine[component * from.size + from.at(i, j, k)];
  };
  const auto around = [&](int component, int i, int j, int k) {
    if (has_cell(fine_, i, j, k)) return value(component, i, j, k);
    Real sum = 0;
    int n = 0;
    for (int c = std::max(k - 1, 0); c <= std::min(k + 1, fine_.cells[2]); ++c)
      for (int b = std::max(j - 1, 0); b <= std::min(j + 1, fine_.cells[1]); ++b)
        for (int a = std::max(i - 1, 0); a <= std::min(i + 1, fine_.cells[0]); ++a)
          if (has_cell(fine_, a, b, c)) {
            sum += value(component, a, b, c);
            ++n;
          }
    return n > 0 ? sum / static_cast<Real>(n) : Real(0);
  };
#pragma omp parallel for num_threads(n_threads_)                                                             \
    schedule(static) if (n_threads_ > 1 && fine_.layout.size > piece)
  for (int k = 0; k < to.nodes[2]; ++k)
    for (int j = 0; j < to.nodes[1]; ++j)
      for (int i = 0; i < to.nodes[0]; ++i) {
        const int node[3] = {factor[0] * i, factor[1] * j, factor[2] * k};
        int inside[3], before[3];
        bool beyond = false;
        for (std::size_t a = 0; a < 3; ++a) {
          inside[a] = std::min(node[a], fine_.cells[a]);
          before[a] = inside[a] - (node[a] - inside[a]);
          beyond = beyond || before[a] != inside[a];
        }
        for (int component = 0; component < 3; ++component) {
          Real at = around(component, inside[0], inside[1], inside[2]);
          if (beyond) at += at - around(component, before[0], before[1], before[2]);
          coarse[component * to.size + to.at(i, j, k)] = at;
        }
      }
  // Held nodes may lie beyond the body: they keep what was extrapolated, being no unknowns.
}

template class Transfer<double>;
template class Transfer<float>;

} // namespace springproof::msm::grid
