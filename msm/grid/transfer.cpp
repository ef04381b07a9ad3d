#include "msm/grid/transfer.hpp"

#include "cases/mesh/mesh.hpp"

namespace springproof::msm::grid {

namespace {

/// Copies between a field of the whole grid, on every rank, and a part's.
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

std::array<int, 3> factor_between(const Body& fine, const Body& coarse) {
  std::array<int, 3> factor;
  for (std::size_t a = 0; a < 3; ++a)
    factor[a] = coarse.spacing[static_cast<int>(a)] != fine.spacing[static_cast<int>(a)] ? 2 : 1;
  return factor;
}

std::array<int, 3> shift_between(const Body& fine, const Body& coarse, const std::array<int, 3>& factor) {
  std::array<int, 3> shift{};
  for (std::size_t a = 0; a < 3 && fine.part; ++a)
    shift[a] = factor[a] * coarse.part->first[a] - fine.part->first[a];
  return shift;
}

} // namespace

template<class Real>
Transfer<Real>::Transfer(const Body& fine, const Body& coarse, int n_threads)
    : fine_(fine), coarse_(coarse),
      coarse_here_(fine.part && !coarse.part ? *fine.part->coarser_here : coarse), n_threads_(n_threads),
      factor_(factor_between(fine, coarse)), shift_(shift_between(fine, coarse_here_, factor_)),
      interpolation_(fine.layout, coarse_here_.layout, factor_, shift_, n_threads) {
  if (!fine.is_uniform())
    for_each_place(fine.layout.nodes,
                   [&](int i, int j, int k) { has_cell_.push_back(has_cell(fine, i, j, k) ? 1 : 0); });
}

template<class Real>
void Transfer<Real>::prolong(const Field<Real>& coarse, Field<Real>& fine) const {
  if (gathers())
    interpolation_.prolong(take_part(coarse_, coarse, coarse_here_), fine);
  else
    interpolation_.prolong(coarse, fine);
  clear_constrained(fine_, fine);
}

/// Calls make(coarse field here), and completes it.
template<class Real>
template<class Make>
void Transfer<Real>::make_coarse(Field<Real>& coarse, const Make& make) const {
  if (gathers()) {
    Field<Real> here = Field<Real>::Zero(3 * coarse_here_.layout.size);
    make(here);
    gather(coarse_here_, here, coarse_, coarse);
  } else {
    make(coarse);
  }
}

template<class Real>
void Transfer<Real>::restrict(const Field<Real>& fine, Field<Real>& coarse) const {
  make_coarse(coarse, [&](Field<Real>& here) {
    interpolation_.restrict(fine, here, 0, coarse_here_.layout.nodes[2]);
  });
  clear_constrained(coarse_, coarse);
  update_ghosts(coarse_, coarse);
}

template<class Real>
void Transfer<Real>::sample(const Field<Real>& fine, Field<Real>& coarse) const {
  make_coarse(coarse, [&](Field<Real>& here) { sample_here(fine, here); });
  update_ghosts(coarse_, coarse);
}

template<class Real>
void Transfer<Real>::sample_here(const Field<Real>& fine, Field<Real>& coarse) const {
  const Layout &from = fine_.layout, &to = coarse_here_.layout;
  // Some cells at a part's ghosts are not here: their means may have fewer nodes than on the whole body,
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
          const int on_fine = factor_[a] * node[a] + shift_[a];
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
