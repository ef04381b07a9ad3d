#include "msm/grid/part.hpp"

#include "msm/grid/body.hpp"

namespace springproof::msm::grid {

Body cut_out(const Body& whole, const std::array<int, 3>& first, const std::array<int, 3>& last) {
  Body here;
  here.spacing = whole.spacing;
  here.exponents = whole.exponents;
  Part part;
  std::array<int, 3> n_nodes;
  for (std::size_t a = 0; a < 3; ++a) {
    part.whole_nodes[a] = whole.layout.nodes[a];
    part.first[a] = std::max(first[a] - 1, 0);
    n_nodes[a] = std::min(last[a] + 1, part.whole_nodes[a]) - part.first[a];
    here.cells[a] = n_nodes[a] - 1;
    part.own_first[a] = first[a] - part.first[a];
    part.own_last[a] = last[a] - part.first[a];
  }
  if (whole.is_uniform())
    here.springs = whole.springs;
  else
    for_each_place(here.cells, [&](int i, int j, int k) {
      here.springs.push_back(whole.cell(part.first[0] + i, part.first[1] + j, part.first[2] + k));
    });
  here.layout = make_layout(here.cells);
  for (const std::ptrdiff_t entry : whole.constrained) {
    const auto [i, j, k, c] = whole.layout.place(entry);
    const std::array<int, 3> at{i - part.first[0], j - part.first[1], k - part.first[2]};
    const auto is_here = [&](std::size_t a) { return at[a] >= 0 && at[a] < n_nodes[a]; };
    if (is_here(0) && is_here(1) && is_here(2))
      here.constrained.push_back(here.layout.at(at[0], at[1], at[2], c));
  }
  here.part = std::move(part);
  return here;
}

} // namespace springproof::msm::grid
