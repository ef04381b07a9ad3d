// The kernels' one source, compiled once per instruction set with SPRINGPROOF_ISA as the name of the set.
// It must include nothing that defines functions others share: the linker might keep the copy compiled for
// instructions that the machine lacks.
#include "msm/grid/kernels.hpp"

#include <immintrin.h> // intrinsics are always inlined: no shared functions

#define SPRINGPROOF_INLINE inline __attribute__((always_inline))

namespace springproof::msm::grid::SPRINGPROOF_ISA {

namespace {

#include "msm/grid/kernels_packs.hpp"

#include "msm/grid/kernels_springs.hpp"

#include "msm/grid/kernels_cells.hpp"

// ---- the four kernels ------------------------------------------------------------------------------------

template<class Real>
void force(const Springs<Real>& s, const Slab<Real>& slab, const Real* displacement, Real* result) {
  sweep_springs(s, slab, Force<Real>{}, displacement, displacement, result);
  if (s.volume_stiffness) volume_force(s, slab, displacement, result);
}

template<class Real>
void product(const Springs<Real>& s, const Slab<Real>& slab, Clamp clamp, const Real* displacement,
             const Real* direction, Real* result) {
  if (clamp == Clamp::yes)
    sweep_springs(s, slab, Product<Real, Clamp::yes>{}, displacement, direction, result);
  else
    sweep_springs(s, slab, Product<Real, Clamp::no>{}, displacement, direction, result);
  if (!s.volume_stiffness) return;
  if (clamp == Clamp::yes)
    volume_product<Real, Clamp::yes>(s, slab, displacement, direction, result);
  else
    volume_product<Real, Clamp::no>(s, slab, displacement, direction, result);
}

/// Distance, in a field's memory, from a node to the other end of its spring.
SPRINGPROOF_INLINE std::ptrdiff_t reach(const Layout& layout, int spring) {
  if (spring == n_springs - 1) return 1;
  return spring % 3 - 1 + group_dy[spring / 3] * layout.row + group_dz[spring / 3] * layout.plane;
}
SPRINGPROOF_INLINE bool leads_upwards(int spring) {
  return spring < n_springs - 1 && group_dz[spring / 3] == 1;
}

template<class Real>
SPRINGPROOF_INLINE void clear(Real* begin, std::ptrdiff_t n) {
  for (std::ptrdiff_t i = 0; i < n; ++i) begin[i] = 0;
}

/// k (1 - l0/|d|), and 1/|d|.
template<class Real>
SPRINGPROOF_INLINE Real tension(const Vec<Real>& d, Real k, Real rest_length, Real& inverse_length) {
  const Real squared = dot(d, d);
  inverse_length = inverse_root(squared > Real(1e-30) ? squared : Real(1e-30));
  return k * (Real(1) - rest_length * inverse_length);
}

template<class Real>
double energy(const Springs<Real>& s, int first, int last, const Real* displacement) {
  const Layout& layout = s.layout;
  const std::ptrdiff_t n = (layout.row * layout.nodes[1] + 15) / 16 * 16;
  double total = 0;
  for (int k = first; k < last; ++k) {
    const Rows<const Real> u = rows(displacement, layout.size, layout.at(0, 0, k));
    for (int spring = 0; spring < n_springs; ++spring) {
      if (leads_upwards(spring) && k + 1 == layout.nodes[2]) continue;
      const Rows<const Real> other = shifted(u, reach(layout, spring));
      const Share<Real> share = spring_share(s, spring, k);
      const Vec<Real> d = rest_of(s, spring);
      const Real l0 = s.rest_length[spring];
      Real sum = 0;
      for (std::ptrdiff_t i = 0; i < n; ++i) {
        const Vec<Real> now = d + (other.at(i) - u.at(i));
        const Real squared = dot(now, now);
        const Real elongation = squared * inverse_root(squared > Real(1e-30) ? squared : Real(1e-30)) - l0;
        sum += share.share[i] * elongation * elongation;
      }
      total += 0.5 * static_cast<double>(share.scale) * static_cast<double>(sum);
    }
    if (!s.volume_stiffness || k + 1 == layout.nodes[2]) continue;
    const CellRows<Real> cell = cell_rows(layout, displacement, 0, k);
    const Real* stiffness = s.volume_stiffness + layout.at(0, 0, k);
    const Vec<Real> h = cell_edges(s);
    Real sum = 0;
    for (std::ptrdiff_t i = 0; i < cells_of_plane(layout); ++i) {
      Vec<Real> x[8], g[8];
      cell_positions(cell, i, h, x);
      volume_gradients(x, g);
      const Real change = volume(x, g) - s.rest_volume;
      sum += stiffness[i] * change * change;
    }
    total += 0.5 * static_cast<double>(sum);
  }
  return total;
}

/// Blocks of the springs: t I + (k - t) d d^T/|d|², to both ends. Not the time-critical one: the ends get
/// theirs one spring at a time.
template<class Real>
void diagonal(const Springs<Real>& s, const Slab<Real>& slab, Clamp clamp, const Real* displacement,
              Real* result) {
  const Layout& layout = s.layout;
  for (int c = 0; c < 6; ++c) {
    clear(result + c * layout.size + layout.plane * (slab.first + 1),
          layout.plane * (slab.last - slab.first));
    clear(slab.spill + c * layout.plane, layout.plane);
  }
  const Real least = clamp == Clamp::yes ? Real(0) : Real(-1e30);
  const std::ptrdiff_t n = (layout.row * layout.nodes[1] + 15) / 16 * 16;
  const auto target = [&](int k, int c) {
    return k < slab.last ? result + c * layout.size + layout.at(0, 0, k)
                         : slab.spill + c * layout.plane + layout.at(0, 0, -1);
  };
  Real* const b = slab.scratch;
  for (int k = slab.first; k < slab.last; ++k) {
    const Rows<const Real> u = rows(displacement, layout.size, layout.at(0, 0, k));
    for (int spring = 0; spring < n_springs; ++spring) {
      const bool upwards = leads_upwards(spring);
      if (upwards && k + 1 == layout.nodes[2]) continue;
      const Rows<const Real> other = shifted(u, reach(layout, spring));
      const std::ptrdiff_t in_plane = reach(layout, spring) - (upwards ? layout.plane : 0);
      const Share<Real> share = spring_share(s, spring, k);
      const Vec<Real> d = rest_of(s, spring);
      const Real l0 = s.rest_length[spring];
      for (std::ptrdiff_t first = 0; first < n; first += block) {
        const std::ptrdiff_t length = first + block < n ? block : n - first;
#pragma GCC ivdep
        for (std::ptrdiff_t i = 0; i < length; ++i) {
          const Vec<Real> now = d + (other.at(first + i) - u.at(first + i));
          const Real stiffness = share.scale * share.share[first + i];
          Real inverse_length;
          Real t = tension(now, stiffness, l0, inverse_length);
          t = t > least * stiffness ? t : least * stiffness;
          const Real along = (stiffness - t) * inverse_length * inverse_length;
          b[i] = t + along * now.x * now.x;
          b[i + block] = t + along * now.y * now.y;
          b[i + 2 * block] = t + along * now.z * now.z;
          b[i + 3 * block] = along * now.y * now.z;
          b[i + 4 * block] = along * now.x * now.z;
          b[i + 5 * block] = along * now.x * now.y;
        }
        for (int c = 0; c < 6; ++c) {
          Real *own = target(k, c) + first, *far = target(k + (upwards ? 1 : 0), c) + first + in_plane;
          const Real* __restrict part = b + c * block;
          for (std::ptrdiff_t i = 0; i < length; ++i) own[i] += part[i];
          for (std::ptrdiff_t i = 0; i < length; ++i) far[i] += part[i];
        }
      }
    }
    if (!s.volume_stiffness || k + 1 == layout.nodes[2]) continue;
    const CellRows<Real> cell = cell_rows(layout, displacement, 0, k);
    const Real* stiffness = s.volume_stiffness + layout.at(0, 0, k);
    const Vec<Real> h = cell_edges(s);
    for (std::ptrdiff_t i = 0; i < layout.row * (layout.nodes[1] - 1); ++i) {
      Vec<Real> x[8], g[8];
      cell_positions(cell, i, h, x);
      volume_gradients(x, g);
      for (int v = 0; v < 8; ++v) {
        const Real products[6] = {g[v].x * g[v].x, g[v].y * g[v].y, g[v].z * g[v].z,
                                  g[v].y * g[v].z, g[v].x * g[v].z, g[v].x * g[v].y};
        for (int c = 0; c < 6; ++c)
          target(k + (v >> 2), c)[i + (v & 1) + ((v >> 1) & 1) * layout.row] += stiffness[i] * products[c];
      }
    }
  }
}

} // namespace

extern const Kernels<double> double_kernels;
extern const Kernels<float> float_kernels;
const Kernels<double> double_kernels{force<double>, product<double>, diagonal<double>, energy<double>};
const Kernels<float> float_kernels{force<float>, product<float>, diagonal<float>, energy<float>};

} // namespace springproof::msm::grid::SPRINGPROOF_ISA
