// The kernels' one source, compiled once per instruction set with SPRINGPROOF_ISA as the name of the set.
// It must include nothing that defines functions others share: the linker might keep the copy compiled for
// instructions that the machine lacks.
#include "mechanics/grid/packs.hpp"
#include "msm/grid/kernels.hpp"

namespace springproof::msm::grid {

using namespace mechanics;

namespace {

#include "msm/grid/kernels_rows.hpp"

#include "msm/grid/kernels_laws.hpp"

#include "msm/grid/kernels_springs.hpp"

#include "msm/grid/kernels_cells.hpp"

#include "msm/grid/kernels_substitution.hpp"

#include "mechanics/grid/kernels_masses.hpp"

// ---- the four kernels ------------------------------------------------------------------------------------

template<class Real>
void force(const Springs<Real>& s, const Slab<Real>& slab, const Real* displacement, Real* result) {
  with_laws(s, [&](const auto& laws) {
    sweep_springs(s, slab, Force<std::decay_t<decltype(laws)>, Real>{laws}, displacement, displacement,
                  result);
    if (s.midline[0])
      cell_force<true>(s, slab, laws, displacement, result);
    else if (s.volume_stiffness)
      cell_force<false>(s, slab, laws, displacement, result);
  });
}

template<class Real, Clamp clamp>
void product_with(const Springs<Real>& s, const Slab<Real>& slab, const Real* displacement,
                  const Real* direction, Real* result) {
  with_laws(s, [&](const auto& laws) {
    sweep_springs(s, slab, Product<std::decay_t<decltype(laws)>, Real, clamp>{laws}, displacement, direction,
                  result);
    if (s.midline[0])
      cell_product<clamp, true>(s, slab, laws, displacement, direction, result);
    else if (s.volume_stiffness)
      cell_product<clamp, false>(s, slab, laws, displacement, direction, result);
  });
}
template<class Real>
void product(const Springs<Real>& s, const Slab<Real>& slab, Clamp clamp, const Real* displacement,
             const Real* direction, Real* result) {
  const auto& run = clamp == Clamp::yes ? product_with<Real, Clamp::yes> : product_with<Real, Clamp::no>;
  run(s, slab, displacement, direction, result);
}

/// One spring of every node of plane k.
template<class Real>
struct PlaneOfSprings {
  Rows<Real> nodes, others;
  Share<Real> share;
  Vec<Real> rest;
  std::ptrdiff_t in_plane; ///< distance to the other end in its own plane
  /// The vectors from a pack of nodes to the other ends.
  SPRINGPROOF_INLINE Vec<Pack<Real>> at(std::ptrdiff_t i) const {
    using P = Pack<Real>;
    return Vec<P>{P{} + rest.x, P{} + rest.y, P{} + rest.z} + (others.pack_at(i) - nodes.pack_at(i));
  }
};
template<class Real>
SPRINGPROOF_INLINE PlaneOfSprings<Real> plane_of_springs(const Springs<Real>& s, int spring, int k,
                                                         const Real* displacement) {
  const auto& [dx, dy, dz] = spring_steps[spring];
  const auto& [x, y, z] = s.rest[spring];
  const std::ptrdiff_t here = s.layout.at(0, 0, k), in_plane = dx + dy * s.layout.row;
  return {rows(displacement, s.layout.size, here),
          rows(displacement, s.layout.size, here + in_plane + dz * s.layout.plane),
          spring_share(s, spring, k),
          {x, y, z},
          in_plane};
}

template<class P>
SPRINGPROOF_INLINE RealOf<P> sum_of(const P& pack) {
  RealOf<P> sum = 0;
  for (int l = 0; l < pack_size<RealOf<P>>; ++l) sum += pack[l];
  return sum;
}

/// Twice the energy of the volume terms and midlines of plane k.
template<class Real, class Laws>
Real twice_energy_of_cells(const Springs<Real>& s, const Laws& laws, int k, const Real* displacement) {
  using P = Pack<Real>;
  const std::ptrdiff_t n = cells_of_plane(s.layout);
  const Cells<Real> cells = cells_from(s, displacement, 0, k);
  P sum{};
  for (std::ptrdiff_t first = 0; first < n; first += block) {
    const std::ptrdiff_t length = first + block < n ? block : n - first;
    Real volumes[block], squared[3][block]; // what cells and their midlines have
#pragma GCC ivdep
    for (std::ptrdiff_t i = 0; i < length; ++i) {
      Vec<Real> x[8], g[8], d[3];
      cells.positions(first + i, x);
      volume_gradients(x, g);
      volumes[i] = volume(x, g);
      fourfold_midlines(x, d);
      for (int a = 0; a < 3; ++a) squared[a][i] = squared_midline(d[a]);
    }
    for (std::ptrdiff_t i = 0; i < length; i += pack_size<Real>) {
      const P counted = load(s.counted + first + i);
      sum += laws.volume.twice_energy(load(volumes + i), P(counted * load(cells.stiffness + first + i)));
      for (int a = 0; a < 3 && s.midline[0]; ++a)
        sum += laws.spring[edge_along[a]].twice_energy(load(squared[a] + i),
                                                       P(counted * load(cells.midline[a] + first + i)));
    }
  }
  return sum_of(sum);
}

template<class Real, class Laws>
double energy_with(const Springs<Real>& s, const Laws& laws, int first, int last, const Real* displacement) {
  using P = Pack<Real>;
  const Layout& layout = s.layout;
  const std::ptrdiff_t n = (layout.row * layout.nodes[1] + 15) / 16 * 16;
  double total = 0;
  for (int k = first; k < last; ++k) {
    for (int spring = 0; spring < n_springs; ++spring) {
      if (k + spring_steps[spring][2] == layout.nodes[2]) continue;
      const PlaneOfSprings<Real> springs = plane_of_springs(s, spring, k, displacement);
      P sum{};
      for (std::ptrdiff_t i = 0; i < n; i += pack_size<Real>) {
        sum += laws.spring[spring].twice_energy(squared_length(springs.at(i)),
                                                P(load(s.counted + i) * load(springs.share.share + i)));
      }
      total += 0.5 * static_cast<double>(springs.share.scale) * static_cast<double>(sum_of(sum));
    }
    if (s.volume_stiffness && k + 1 < layout.nodes[2])
      total += 0.5 * static_cast<double>(twice_energy_of_cells(s, laws, k, displacement));
  }
  return total;
}

template<class Real>
double energy(const Springs<Real>& s, int first, int last, const Real* displacement) {
  return with_laws(s, [&](const auto& laws) { return energy_with(s, laws, first, last, displacement); });
}

/// Adds transverse I + along d d^T to the entries xx, yy, zz, yz, xz, xy.
template<class Real>
SPRINGPROOF_INLINE void add_block(Real transverse, Real along, const Vec<Real>& d, Real (&sum)[6]) {
  sum[0] += transverse + along * d.x * d.x;
  sum[1] += transverse + along * d.y * d.y;
  sum[2] += transverse + along * d.z * d.z;
  sum[3] += along * d.y * d.z;
  sum[4] += along * d.x * d.z;
  sum[5] += along * d.x * d.y;
}

/// Blocks of the springs to both ends. Not the time-critical one: the ends get theirs one spring at a time.
template<Clamp clamp, class Real, class Laws>
void diagonal_with(const Springs<Real>& s, const Slab<Real>& slab, const Laws& laws, const Real* displacement,
                   Real* result) {
  using P = Pack<Real>;
  const Layout& layout = s.layout;
  const auto clear = [](Real* begin, std::ptrdiff_t n) {
    for (std::ptrdiff_t i = 0; i < n; ++i) begin[i] = 0;
  };
  for (int c = 0; c < 6; ++c) {
    clear(result + c * layout.size + layout.plane * (slab.first + 1),
          layout.plane * (slab.last - slab.first));
    clear(slab.spill + c * layout.plane, layout.plane);
  }
  const std::ptrdiff_t n = (layout.row * layout.nodes[1] + 15) / 16 * 16;
  Real* const b = slab.scratch;
  for (int k = slab.first; k < slab.last; ++k) {
    for (int spring = 0; spring < n_springs; ++spring) {
      const int dz = spring_steps[spring][2];
      if (k + dz == layout.nodes[2]) continue;
      const PlaneOfSprings<Real> springs = plane_of_springs(s, spring, k, displacement);
      for (std::ptrdiff_t first = 0; first < n; first += block) {
        const std::ptrdiff_t length = first + block < n ? block : n - first;
        for (std::ptrdiff_t i = 0; i < length; i += pack_size<Real>) {
          const Vec<P> d = springs.at(first + i);
          const P stiffness = springs.share.scale * load(springs.share.share + first + i);
          const SpringTangent<P> tangent =
              laws.spring[spring].template tangent<clamp>(squared_length(d), stiffness);
          P blocks[6] = {};
          add_block(tangent.transverse, tangent.along, d, blocks);
          for (int c = 0; c < 6; ++c) store(b + i + c * block, blocks[c]);
        }
        for (int c = 0; c < 6; ++c) {
          Real *own = result_plane(layout, slab, result, k, c) + first,
               *far = result_plane(layout, slab, result, k + dz, c) + first + springs.in_plane;
          const Real* __restrict part = b + c * block;
          for (std::ptrdiff_t i = 0; i < length; ++i) own[i] += part[i];
          for (std::ptrdiff_t i = 0; i < length; ++i) far[i] += part[i];
        }
      }
    }
    if (!s.volume_stiffness || k + 1 == layout.nodes[2]) continue;
    const Cells<Real> cells = cells_from(s, displacement, 0, k);
    for (std::ptrdiff_t i = 0; i < layout.row * (layout.nodes[1] - 1); ++i) {
      Vec<Real> x[8], g[8];
      cells.positions(i, x);
      volume_gradients(x, g);
      const Real slope = laws.volume.template slope<clamp>(volume(x, g), cells.stiffness[i]);
      Real of_midlines[6] = {};
      Vec<Real> d[3];
      fourfold_midlines(x, d);
      for (int a = 0; a < 3 && s.midline[0]; ++a) {
        const auto [t, along] = laws.spring[edge_along[a]].template tangent<clamp>(squared_midline(d[a]),
                                                                                   cells.midline[a][i] / 16);
        add_block(t, along / 16, d[a], of_midlines);
      }
      for (int v = 0; v < 8; ++v) {
        Real sum[6];
        for (int c = 0; c < 6; ++c) sum[c] = of_midlines[c];
        add_block(Real(0), slope, g[v], sum);
        for (int c = 0; c < 6; ++c)
          result_plane(layout, slab, result, k + (v >> 2), c)[i + (v & 1) + ((v >> 1) & 1) * layout.row] +=
              sum[c];
      }
    }
  }
}

template<class Real>
void diagonal(const Springs<Real>& s, const Slab<Real>& slab, Clamp clamp, const Real* displacement,
              Real* result) {
  with_laws(s, [&](const auto& laws) {
    if (clamp == Clamp::yes)
      diagonal_with<Clamp::yes>(s, slab, laws, displacement, result);
    else
      diagonal_with<Clamp::no>(s, slab, laws, displacement, result);
  });
}

template<class Real>
constexpr Kernels<Real> all{force<Real>,          product<Real>,    diagonal<Real>, energy<Real>,
                            pack_stiffness<Real>, mass_layer<Real>, pack_size<Real>};

} // namespace

const KernelSet SPRINGPROOF_ISA::kernels{all<double>, all<float>, substitute};

} // namespace springproof::msm::grid
