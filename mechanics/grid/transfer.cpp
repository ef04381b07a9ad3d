#include "mechanics/grid/transfer.hpp"

#include <cmath>

namespace springproof::mechanics::grid {

namespace {

/// Rows that a row is made from, along one axis, and their weights.
struct Rows {
  int n;
  int at[3];
  double weight[3];
};

Rows interpolate_from(int i, int factor, int shift) {
  i -= shift;
  if (factor == 1) return {1, {i}, {1}};
  if (i % 2 == 0) return {1, {i / 2}, {1}};
  return {2, {i / 2, i / 2 + 1}, {0.5, 0.5}};
}

Rows restrict_from(int i, int factor, int shift) {
  const int at = factor * i + shift;
  if (factor == 1) return {1, {at}, {1}};
  return {3, {at - 1, at, at + 1}, {0.5, 1, 0.5}};
}

// Two ghosts before for a part's coarse ones, and three after for coarse cells that reach beyond the body.
constexpr int lead = 2, trail = 3; ///< ghosts before and after a row

} // namespace

std::optional<std::array<int, 3>> coarsening_factor(const std::array<int, 3>& cells,
                                                    const Eigen::Vector3d& spacing) {
  double smallest = INFINITY;
  for (std::size_t a = 0; a < 3; ++a)
    if (cells[a] > 2) smallest = std::min(smallest, spacing[static_cast<int>(a)]);
  if (std::isinf(smallest)) return std::nullopt;
  std::array<int, 3> factor;
  for (std::size_t a = 0; a < 3; ++a)
    factor[a] = cells[a] > 2 && spacing[static_cast<int>(a)] < 1.5 * smallest ? 2 : 1;
  return factor;
}

template<class Real>
Interpolation<Real>::Interpolation(const Layout& fine, const Layout& coarse, const std::array<int, 3>& factor,
                                   const std::array<int, 3>& shift, int n_threads)
    : fine_(fine), coarse_(coarse), factor_(factor), shift_(shift), n_threads_(n_threads),
      rows_(std::max(fine.nodes[0], coarse.nodes[0]) + lead + trail,
            std::max(fine.nodes[2], coarse.nodes[2])) {}

/// Makes every row of a result: adds up weighted rows of the source, which the stencil selects along y and z,
/// and calls along_x(sum, row of the result).
template<class Real>
template<class Stencil, class AlongX>
void Interpolation<Real>::transfer(const Layout& from, const Field<Real>& source, const Layout& to,
                                   Field<Real>& result, int begin, int end, const Stencil& stencil,
                                   const AlongX& along_x) const {
  for_each_plane(begin, end, to.size <= worth_threads ? 1 : n_threads_, [&](int k) {
    const Rows z = stencil(k, factor_[2], shift_[2]);
    auto sum = rows_.col(k);
    for (int component = 0; component < 3; ++component)
      for (int j = 0; j < to.nodes[1]; ++j) {
        const Rows y = stencil(j, factor_[1], shift_[1]);
        sum.setZero();
        for (int c = 0; c < z.n; ++c)
          for (int b = 0; b < y.n; ++b) {
            if (y.at[b] < 0 || y.at[b] >= from.nodes[1] || z.at[c] < 0 || z.at[c] >= from.nodes[2]) continue;
            sum.segment(lead, from.nodes[0]) +=
                static_cast<Real>(y.weight[b] * z.weight[c]) *
                source.segment(from.at(0, y.at[b], z.at[c], component), from.nodes[0]);
          }
        const Real* in = sum.data() + lead;
        Real* out = result.data() + to.at(0, j, k, component);
        if (factor_[0] == 2)
          along_x(in, out);
        else
          std::copy(in, in + to.nodes[0], out);
      }
  });
}

template<class Real>
void Interpolation<Real>::prolong(const Field<Real>& coarse, Field<Real>& fine) const {
  transfer(coarse_, coarse, fine_, fine, 0, fine_.nodes[2], interpolate_from,
           [n = fine_.nodes[0], shift = shift_[0]](const Real* in, Real* out) {
             for (int i = -shift; i < n; i += 2) out[i] = in[(i - shift) / 2];
             for (int i = 1 + shift; i < n; i += 2) {
               const Real* const before = in + (i - shift) / 2;
               out[i] = Real(0.5) * (before[0] + before[1]);
             }
           });
}

template<class Real>
void Interpolation<Real>::restrict(const Field<Real>& fine, Field<Real>& coarse, int begin, int end) const {
  transfer(fine_, fine, coarse_, coarse, begin, end, restrict_from,
           [n = coarse_.nodes[0], shift = shift_[0]](const Real* in, Real* out) {
             for (int i = 0; i < n; ++i) {
               const Real* const at = in + 2 * i + shift;
               out[i] = at[0] + Real(0.5) * (at[-1] + at[1]);
             }
           });
}

template class Interpolation<double>;
template class Interpolation<float>;

} // namespace springproof::mechanics::grid
