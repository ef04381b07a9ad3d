#include "msm/grid/transfer.hpp"

#include "cases/mesh/hex_mesh.hpp"

namespace springproof::msm::grid {

namespace {

/// Rows that a row is made from, along one axis, and their weights.
struct Stencil {
  int n;
  int at[3];
  double weight[3];
};

Stencil interpolate_from(int i, bool is_coarsened, int shift) {
  i -= shift;
  if (!is_coarsened) return {1, {i}, {1}};
  if (i % 2 == 0) return {1, {i / 2}, {1}};
  return {2, {i / 2, i / 2 + 1}, {0.5, 0.5}};
}

Stencil restrict_from(int i, bool is_coarsened, int shift) {
  if (!is_coarsened) return {1, {i + shift}, {1}};
  const int at = 2 * i + shift;
  return {3, {at - 1, at, at + 1}, {0.5, 1, 0.5}};
}

// Two ghosts before for a part's coarse ones, and three after for coarse cells that reach beyond the body.
constexpr int lead = 2, trail = 3; ///< ghosts before and after a row

/// Between all nodes of a grid on every rank, and a part's.
template<class Real>
void gather(const Body& here, const Field<Real>& part, const Body& whole, Field<Real>& all) {
  all.setZero();
  for (int c = 0; c < 3; ++c)
    for_each_place(here.layout.nodes, [&](int i, int j, int k) {
      const auto& [x, y, z] = here.part->first;
      if (here.part->owns(i, j, k))
        all[whole.layout.at(x + i, y + j, z + k, c)] = part[here.layout.at(i, j, k, c)];
    });
  here.part->ranks->sum(all.data(), cases::index(all.size()));
}
template<class Real>
Field<Real> take_part(const Body& whole, const Field<Real>& all, const Body& here) {
  Field<Real> part = Field<Real>::Zero(3 * here.layout.size);
  for (int c = 0; c < 3; ++c)
    for_each_place(here.layout.nodes, [&](int i, int j, int k) {
      const auto& [x, y, z] = here.part->first;
      part[here.layout.at(i, j, k, c)] = all[whole.layout.at(x + i, y + j, z + k, c)];
    });
  return part;
}

/// Every row of a result: weighted rows of the source, over what the stencils select along y and z, then
/// along_x(that row, row of the result).
/// @param room  for a row of the source with its ghosts, a column for every plane of the result
template<class Real, class AlongX>
void transfer_rows(const Layout& from, const Field<Real>& source, const Layout& to, Field<Real>& result,
                   Stencil (*stencil)(int, bool, int), const bool (&is_coarsened)[3], const int (&shift)[3],
                   int n_threads, Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>& room,
                   const AlongX& along_x) {
  for_each_plane(to, n_threads, [&](int k) {
    const Stencil z = stencil(k, is_coarsened[2], shift[2]);
    auto sum = room.col(k);
    for (int component = 0; component < 3; ++component)
      for (int j = 0; j < to.nodes[1]; ++j) {
        const Stencil y = stencil(j, is_coarsened[1], shift[1]);
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
    : fine_(fine), coarse_(coarse),
      coarse_here_(fine.part && !coarse.part ? *fine.part->coarser_here : coarse), n_threads_(n_threads) {
  for (std::size_t a = 0; a < 3; ++a) {
    is_coarsened_[a] = coarse.spacing[static_cast<int>(a)] != fine.spacing[static_cast<int>(a)];
    shift_[a] =
        fine.part ? (is_coarsened_[a] ? 2 : 1) * coarse_here_.part->first[a] - fine.part->first[a] : 0;
  }
  if (!fine.is_uniform())
    for_each_place(fine.layout.nodes,
                   [&](int i, int j, int k) { has_cell_.push_back(has_cell(fine, i, j, k) ? 1 : 0); });
  const Layout &from = fine.layout, &to = coarse_here_.layout;
  rows_.resize(std::max(from.nodes[0], to.nodes[0]) + lead + trail, std::max(from.nodes[2], to.nodes[2]));
}

template<class Real>
void Transfer<Real>::prolong(const Field<Real>& coarse, Field<Real>& fine) const {
  const int n = fine_.layout.nodes[0], shift = shift_[0];
  const Field<Real> taken = gathers() ? take_part(coarse_, coarse, coarse_here_) : Field<Real>{};
  transfer_rows(coarse_here_.layout, gathers() ? taken : coarse, fine_.layout, fine, interpolate_from,
                is_coarsened_, shift_, n_threads_, rows_, [n, shift](const Real* in, Real* out) {
                  for (int i = -shift; i < n; i += 2) out[i] = in[(i - shift) / 2];
                  for (int i = 1 + shift; i < n; i += 2) {
                    const Real* const before = in + (i - shift) / 2;
                    out[i] = Real(0.5) * (before[0] + before[1]);
                  }
                });
  clear_constrained(fine_, fine);
}

template<class Real>
void Transfer<Real>::restrict(const Field<Real>& fine, Field<Real>& coarse) const {
  const int n = coarse_here_.layout.nodes[0];
  const auto restrict_to = [&](Field<Real>& here) {
    transfer_rows(fine_.layout, fine, coarse_here_.layout, here, restrict_from, is_coarsened_, shift_,
                  n_threads_, rows_, [n, at = shift_[0]](const Real* in, Real* out) {
                    for (int i = 0; i < n; ++i)
                      out[i] = in[2 * i + at] + Real(0.5) * (in[2 * i + at - 1] + in[2 * i + at + 1]);
                  });
  };
  if (gathers()) {
    Field<Real> here = Field<Real>::Zero(3 * coarse_here_.layout.size);
    restrict_to(here);
    gather(coarse_here_, here, coarse_, coarse);
  } else {
    restrict_to(coarse);
  }
  clear_constrained(coarse_, coarse);
  update_ghosts(coarse_, coarse);
}

template<class Real>
void Transfer<Real>::sample(const Field<Real>& fine, Field<Real>& coarse) const {
  if (gathers()) {
    Field<Real> here = Field<Real>::Zero(3 * coarse_here_.layout.size);
    sample_here(fine, here);
    gather(coarse_here_, here, coarse_, coarse);
  } else {
    sample_here(fine, coarse);
  }
  update_ghosts(coarse_, coarse);
}

template<class Real>
void Transfer<Real>::sample_here(const Field<Real>& fine, Field<Real>& coarse) const {
  const Layout &from = fine_.layout, &to = coarse_here_.layout;
  // Of a part's ghosts not all cells are here: such a mean may be of fewer nodes than on the whole body,
  // which only the preconditioner meets.
  const auto moves = [&](int i, int j, int k) {
    return has_cell_.empty() ||
           has_cell_[cases::index((std::ptrdiff_t{k} * from.nodes[1] + j) * from.nodes[0] + i)] != 0;
  };
  const auto around = [&](int component, const int(&node)[3]) {
    const auto& [i, j, k] = node;
    if (moves(i, j, k)) return fine[from.at(i, j, k, component)];
    Real sum = 0;
    int n = 0;
    for (int c = std::max(k - 1, 0); c <= std::min(k + 1, fine_.cells[2]); ++c)
      for (int b = std::max(j - 1, 0); b <= std::min(j + 1, fine_.cells[1]); ++b)
        for (int a = std::max(i - 1, 0); a <= std::min(i + 1, fine_.cells[0]); ++a)
          if (moves(a, b, c)) {
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
          const int on_fine = (is_coarsened_[a] ? 2 : 1) * node[a] + shift_[a];
          inside[a] = std::clamp(on_fine, 0, fine_.cells[a]); // a part's ghosts get their values elsewhere
          before[a] = std::max(inside[a] - (on_fine - inside[a]), 0);
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
