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

template<class Real, class Tangent>
SPRINGPROOF_INLINE void cell_products(const Springs<Real>& s, const Slab<Real>& slab, const Tangent& tangent,
                                      const Real* displacement, const Real* direction, Real* result) {
  if (s.midline[0])
    cell_product<true>(s, slab, tangent, displacement, direction, result);
  else if (s.volume_stiffness)
    cell_product<false>(s, slab, tangent, displacement, direction, result);
}

template<class Real, Clamp clamp>
void product_with(const Springs<Real>& s, const Slab<Real>& slab, const Real* displacement,
                  const Real* direction, Real* result) {
  with_laws(s, [&](const auto& laws) {
    sweep_springs(s, slab, Product<std::decay_t<decltype(laws)>, Real, clamp>{laws}, displacement, direction,
                  result);
    cell_products(s, slab, TangentByLaw<clamp, Real, std::decay_t<decltype(laws)>>{laws}, displacement,
                  direction, result);
  });
}
template<class Real>
void product(const Springs<Real>& s, const Slab<Real>& slab, Clamp clamp, const Real* displacement,
             const Real* direction, Real* result) {
  const auto& run = clamp == Clamp::yes ? product_with<Real, Clamp::yes> : product_with<Real, Clamp::no>;
  run(s, slab, displacement, direction, result);
}

template<class Real>
void kept_product(const Springs<Real>& s, const Slab<Real>& slab, const Real* kept, const Real* displacement,
                  const Real* direction, Real* result) {
  sweep_springs(s, slab, KeptProduct<Real>{kept}, displacement, direction, result);
  cell_products(s, slab, KeptTangent<Real>{kept}, displacement, direction, result);
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

/// Sets the blocks of the springs of plane k, a spring at a time, which both its ends get.
template<Clamp clamp, class Real, class Laws>
void spring_diagonals(const Springs<Real>& s, const Slab<Real>& slab, const Laws& laws, int k,
                      const Real* displacement, Real* result, Real* kept) {
  using P = Pack<Real>;
  constexpr std::ptrdiff_t lanes = pack_size<Real>;
  const Layout& layout = s.layout;
  const std::ptrdiff_t n = layout.nodes[0];
  for (int spring = 0; spring < n_springs; ++spring) {
    const int dy = spring_steps[spring][1], dz = spring_steps[spring][2];
    if (k + dz == layout.nodes[2]) continue;
    const PlaneOfSprings<Real> springs = plane_of_springs(s, spring, k, displacement);
    Real *own[6], *far[6];
    for (int c = 0; c < 6; ++c) {
      own[c] = result_plane(layout, slab, result, k, c);
      far[c] = result_plane(layout, slab, result, k + dz, c) + springs.in_plane;
    }
    for (int j = dy < 0 ? 1 : 0; j + dy < layout.nodes[1] && j < layout.nodes[1]; ++j) {
      Real* const of_row = kept ? kept + 2 * (packed_row<Real>(layout, k, j) + spring * lanes) : nullptr;
      for (std::ptrdiff_t first = 0; first < n; first += lanes) {
        const std::ptrdiff_t at = j * layout.row + first;
        const Vec<P> d = springs.at(at);
        P stiffness = springs.share.scale * load(springs.share.share + at);
        if (n - first < lanes) stiffness = first_of(n - first, stiffness, P{});
        const SpringTangent<P> tangent =
            laws.spring[spring].template tangent<clamp>(squared_length(d), stiffness);
        if (kept) {
          store(of_row + 2 * first * stiffness_packs, tangent.transverse);
          store(of_row + 2 * first * stiffness_packs + lanes, tangent.along);
        }
        P blocks[6] = {};
        add_block(tangent.transverse, tangent.along, d, blocks);
        for (int c = 0; c < 6; ++c) { // 0 is added beyond the row's end
          add(own[c] + at, blocks[c]);
          add(far[c] + at, blocks[c]);
        }
      }
    }
  }
}

/// Adds the blocks of the volume terms and midlines of plane k.
template<Clamp clamp, class Real, class Laws>
void cell_diagonals(const Springs<Real>& s, const Slab<Real>& slab, const Laws& laws, int k,
                    const Real* displacement, Real* result, Real* kept) {
  const Layout& layout = s.layout;
  const std::ptrdiff_t n = cells_of_plane(layout);
  for (std::ptrdiff_t first = 0; first < n; first += block) {
    const std::ptrdiff_t length = first + block < n ? block : n - first;
    const Cells<Real> cells = cells_from(s, displacement, first, k);
    alignas(64) Real blocks[48][block], numbers[kept_per_cell][block];
#pragma GCC ivdep
    for (std::ptrdiff_t i = 0; i < length; ++i) {
      Vec<Real> x[8], g[8], d[3];
      cells.positions(i, x);
      volume_gradients(x, g);
      const Real slope = laws.volume.template slope<clamp>(volume(x, g), cells.stiffness[i]);
      numbers[0][i] = slope;
      Real of_midlines[6] = {};
      fourfold_midlines(x, d);
      for (int a = 0; a < 3 && s.midline[0]; ++a) {
        const auto [transverse, along] =
            laws.spring[edge_along[a]].template tangent<clamp>(squared_midline(d[a]), cells.midline[a][i]);
        numbers[2 * a + 1][i] = transverse;
        numbers[2 * a + 2][i] = along;
        add_block(transverse / 16, along / 256, d[a], of_midlines);
      }
#pragma GCC unroll 8
      for (int v = 0; v < 8; ++v) {
        Real sum[6];
        for (int c = 0; c < 6; ++c) sum[c] = of_midlines[c];
        add_block(Real(0), slope, g[v], sum);
        for (int c = 0; c < 6; ++c) blocks[6 * v + c][i] = sum[c];
      }
    }
    for (int v = 0; v < 8; ++v)
      for (int c = 0; c < 6; ++c) {
        Real* __restrict to = result_plane(layout, slab, result, k + (v >> 2), c) + first + (v & 1) +
                              ((v >> 1) & 1) * layout.row;
        for (std::ptrdiff_t i = 0; i < length; ++i) to[i] += blocks[6 * v + c][i];
      }
    for (int number = 0; kept && number < (s.midline[0] ? kept_per_cell : 1); ++number) {
      Real* const to = kept + kept_cells(layout) + (kept_per_cell * k + number) * n + first;
      for (std::ptrdiff_t i = 0; i < length; ++i) to[i] = numbers[number][i];
    }
  }
}

template<Clamp clamp, class Real, class Laws>
void diagonal_with(const Springs<Real>& s, const Slab<Real>& slab, const Laws& laws, const Real* displacement,
                   Real* result, Real* kept) {
  const Layout& layout = s.layout;
  const auto clear = [](Real* begin, std::ptrdiff_t n) {
    for (std::ptrdiff_t i = 0; i < n; ++i) begin[i] = 0;
  };
  for (int c = 0; c < 6; ++c) {
    clear(result + c * layout.size + layout.plane * (slab.first + 1),
          layout.plane * (slab.last - slab.first));
    clear(slab.spill + c * layout.plane, layout.plane);
  }
  for (int k = slab.first; k < slab.last; ++k) {
    spring_diagonals<clamp>(s, slab, laws, k, displacement, result, kept);
    if (s.volume_stiffness && k + 1 < layout.nodes[2])
      cell_diagonals<clamp>(s, slab, laws, k, displacement, result, kept);
  }
}

template<class Real>
void diagonal(const Springs<Real>& s, const Slab<Real>& slab, Clamp clamp, const Real* displacement,
              Real* result, Real* kept) {
  with_laws(s, [&](const auto& laws) {
    if (clamp == Clamp::yes)
      diagonal_with<Clamp::yes>(s, slab, laws, displacement, result, kept);
    else
      diagonal_with<Clamp::no>(s, slab, laws, displacement, result, kept);
  });
}

template<class Real>
constexpr Kernels<Real> all{force<Real>,  product<Real>,        kept_product<Real>, diagonal<Real>,
                            energy<Real>, pack_stiffness<Real>, mass_layer<Real>,   pack_size<Real>};

} // namespace

const KernelSet SPRINGPROOF_ISA::kernels{all<double>, all<float>, substitute};

} // namespace springproof::msm::grid
