#include "msm/grid/body.hpp"

#include "cases/case/index.hpp"

#include <algorithm>
#include <cmath>

namespace springproof::msm::grid {

namespace {

using cases::index;

bool is_empty(const CellSprings& s) {
  const auto is_zero = [](double k) { return k == 0; };
  return std::all_of(s.edge.begin(), s.edge.end(), is_zero) &&
         std::all_of(s.face_diagonal.begin(), s.face_diagonal.end(), is_zero) && s.internal_diagonal == 0 &&
         s.volume == 0;
}

} // namespace

const CellSprings& Body::cell(int i, int j, int k) const {
  static const CellSprings none;
  if (i < 0 || j < 0 || k < 0 || i >= cells[0] || j >= cells[1] || k >= cells[2]) return none;
  return is_uniform() ? springs.front() : springs[index(i + cells[0] * (j + std::ptrdiff_t{cells[1]} * k))];
}

Layout make_layout(const std::array<int, 3>& cells) {
  Layout layout;
  for (int a = 0; a < 3; ++a) layout.nodes[a] = cells[index(a)] + 1;
  const auto in_packs = [](std::ptrdiff_t n) { return (n + 15) / 16 * 16; };
  layout.row = layout.nodes[0] + 1;
  layout.lead = in_packs(layout.row + 16);
  layout.plane = in_packs(layout.row * (layout.nodes[1] + 1) + 48);
  layout.size = layout.plane * (layout.nodes[2] + 2) + layout.lead + 32;
  return layout;
}

bool has_cell(const Body& body, int i, int j, int k) {
  if (body.is_uniform()) return true;
  for (int v = 0; v < 8; ++v)
    if (!is_empty(body.cell(i - (v & 1), j - ((v >> 1) & 1), k - (v >> 2)))) return true;
  return false;
}

std::array<bool, 3> axes_to_coarsen(const Body& body) {
  double smallest = INFINITY;
  for (int a = 0; a < 3; ++a)
    if (body.cells[index(a)] > 2) smallest = std::min(smallest, body.spacing[a]);
  std::array<bool, 3> axes{};
  for (int a = 0; a < 3; ++a) axes[index(a)] = body.cells[index(a)] > 2 && body.spacing[a] < 1.5 * smallest;
  return axes;
}

Body coarsen(const Body& fine, const std::array<bool, 3>& axes) {
  Body coarse;
  std::array<int, 3> factor;
  bool divides = true;
  for (std::size_t a = 0; a < 3; ++a) {
    factor[a] = axes[a] ? 2 : 1;
    coarse.cells[a] = (fine.cells[a] + factor[a] - 1) / factor[a];
    divides = divides && fine.cells[a] % factor[a] == 0;
    coarse.spacing[static_cast<int>(a)] = factor[a] * fine.spacing[static_cast<int>(a)];
  }
  const Eigen::Vector3d h = fine.spacing.cwiseAbs2(), H = coarse.spacing.cwiseAbs2();
  const double volume_ratio = fine.spacing.prod() / coarse.spacing.prod();
  const auto add = [&](CellSprings& sum, const CellSprings& part) {
    for (int a = 0; a < 3; ++a) {
      const int b = (a + 1) % 3, c = (a + 2) % 3;
      sum.edge[index(a)] += part.edge[index(a)] * h[a] / H[a];
      sum.face_diagonal[index(a)] += part.face_diagonal[index(a)] * (h[b] + h[c]) / (H[b] + H[c]);
    }
    sum.internal_diagonal += part.internal_diagonal * h.sum() / H.sum();
    sum.volume += part.volume * volume_ratio;
  };
  const auto gathered = [&](int i, int j, int k) {
    CellSprings sum;
    for (int c = 0; c < factor[2]; ++c)
      for (int b = 0; b < factor[1]; ++b)
        for (int a = 0; a < factor[0]; ++a)
          add(sum, fine.cell(factor[0] * i + a, factor[1] * j + b, factor[2] * k + c));
    return sum;
  };
  if (fine.is_uniform() && divides)
    coarse.springs = {gathered(0, 0, 0)};
  else
    for (int k = 0; k < coarse.cells[2]; ++k)
      for (int j = 0; j < coarse.cells[1]; ++j)
        for (int i = 0; i < coarse.cells[0]; ++i) coarse.springs.push_back(gathered(i, j, k));
  set_layout(coarse, [&](int i, int j, int k, int c) {
    const std::ptrdiff_t entry =
        c * fine.layout.size + fine.layout.at(std::min(factor[0] * i, fine.cells[0]),
                                              std::min(factor[1] * j, fine.cells[1]),
                                              std::min(factor[2] * k, fine.cells[2]));
    return std::binary_search(fine.constrained.begin(), fine.constrained.end(), entry);
  });
  return coarse;
}

} // namespace springproof::msm::grid
