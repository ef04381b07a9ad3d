// Part of kernels_source.hpp, in its namespace: vectors of numbers or packs, rows of a field, and the
// stiffnesses of a row's springs, a pack of nodes at a time.
#pragma once

template<class Real>
struct Vec {
  Real x, y, z;
  SPRINGPROOF_INLINE Real& operator[](int c) { return c == 0 ? x : c == 1 ? y : z; }
};
template<class Real>
SPRINGPROOF_INLINE Vec<Real> operator+(const Vec<Real>& a, const Vec<Real>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template<class Real>
SPRINGPROOF_INLINE Vec<Real> operator-(const Vec<Real>& a, const Vec<Real>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template<class Real>
SPRINGPROOF_INLINE Vec<Real> operator*(Real s, const Vec<Real>& a) {
  return {s * a.x, s * a.y, s * a.z};
}
template<class Real>
SPRINGPROOF_INLINE Real dot(const Vec<Real>& a, const Vec<Real>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template<class Real>
SPRINGPROOF_INLINE Vec<Real> cross(const Vec<Real>& a, const Vec<Real>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
using mechanics::window;
template<class P>
SPRINGPROOF_INLINE Vec<P> window(const Vec<P>& a, const Vec<P>& b, int from) {
  return {window(a.x, b.x, from), window(a.y, b.y, from), window(a.z, b.z, from)};
}

/// Three arrays of one row.
template<class Real>
struct Rows {
  const Real *x, *y, *z;
  SPRINGPROOF_INLINE Vec<Real> at(std::ptrdiff_t i) const { return {x[i], y[i], z[i]}; }
  SPRINGPROOF_INLINE Vec<Pack<Real>> pack_at(std::ptrdiff_t i) const {
    return {load(x + i), load(y + i), load(z + i)};
  }
};
template<class Real>
SPRINGPROOF_INLINE Rows<Real> rows(const Real* field, std::ptrdiff_t array, std::ptrdiff_t offset) {
  return {field + offset, field + array + offset, field + 2 * array + offset};
}

/// First node of plane k of a result's array c: in the field, or in the spill.
template<class Real>
SPRINGPROOF_INLINE Real* result_plane(const Layout& layout, const Slab<Real>& slab, Real* field, int k,
                                      int c) {
  return k < slab.last ? field + layout.at(0, 0, k, c) : slab.spill + c * layout.plane + layout.at(0, 0, -1);
}

/// A spring's stiffness along the nodes of plane k: `share` times `scale`.
template<class Real>
struct Share {
  const Real* share;
  Real scale;
};

template<class Real>
SPRINGPROOF_INLINE Share<Real> spring_share(const Springs<Real>& s, int spring, int k) {
  const std::ptrdiff_t plane = s.layout.plane;
  if (s.by_node) return {s.by_node + (n_springs * k + spring) * plane, s.stiffness[spring]};
  const auto& [dx, dy, dz] = spring_steps[spring];
  return {s.share + (3 * (dy + 1) + dx + 1) * plane, s.stiffness[spring] * s.share_z[3 * k + dz + 1]};
}

// The stiffnesses of a row's springs: for every pack of nodes k of the 13 springs, 0 beyond the row's end.
constexpr std::ptrdiff_t stiffness_packs = n_springs;

/// The packs of a row that a sweep works on.
struct Tile {
  std::ptrdiff_t first, n; ///< packs
  bool is_last;            ///< nothing of the row follows
};

template<class Real>
void fill_stiffness(const Springs<Real>& s, const Tile& t, int k, int j, Real* to) {
  using P = Pack<Real>;
  constexpr std::ptrdiff_t lanes = pack_size<Real>;
  for (std::ptrdiff_t p = 0; p < t.n; ++p) {
    const std::ptrdiff_t i = (t.first + p) * lanes, n_left = s.layout.nodes[0] - i;
    for (int spring = 0; spring < n_springs; ++spring) {
      const Share<Real> share = spring_share(s, spring, k);
      P stiffness = share.scale * load(share.share + j * s.layout.row + i);
      if (n_left < lanes) stiffness = first_of(n_left, stiffness, P{});
      store(to + (p * stiffness_packs + spring) * lanes, stiffness);
    }
  }
}

template<class Real>
std::ptrdiff_t packs_of_row(const Layout& layout) {
  return (layout.nodes[0] + pack_size<Real> - 1) / pack_size<Real>;
}

/// Where the stiffnesses of a row by node begin, in whole rows one after the other.
template<class Real>
SPRINGPROOF_INLINE std::ptrdiff_t packed_row(const Layout& layout, int k, int j) {
  return (std::ptrdiff_t{k} * layout.nodes[1] + j) * packs_of_row<Real>(layout) * stiffness_packs *
         pack_size<Real>;
}

/// Returns a row's packs, from data for all packs row by row.
template<class Real, class T>
SPRINGPROOF_INLINE T* of_packs(const Layout& layout, T* all, int k, int j) {
  return all + (std::ptrdiff_t{k} * layout.nodes[1] + j) * packs_of_row<Real>(layout);
}

template<class Real>
void pack_stiffness(const Springs<Real>& s, Real* to, unsigned char* use) {
  const Layout& layout = s.layout;
  const std::ptrdiff_t n_packs = packs_of_row<Real>(layout),
                       n_stiffnesses = stiffness_packs * pack_size<Real>;
  for (std::ptrdiff_t p = 0; p < pack_use_size(layout); ++p) use[p] = 0;
  const auto meets = [&](int k, int j, std::ptrdiff_t p) {
    if (k < layout.nodes[2] && j >= 0 && j < layout.nodes[1])
      of_packs<Real>(layout, use, k, j)[p] |= meets_springs;
  };
  for (int k = 0; k < layout.nodes[2]; ++k)
    for (int j = 0; j < layout.nodes[1]; ++j) {
      Real* const row = to + packed_row<Real>(layout, k, j);
      fill_stiffness(s, {0, n_packs, true}, k, j, row);
      for (std::ptrdiff_t p = 0; p < n_packs; ++p) {
        bool any = false;
        for (std::ptrdiff_t i = 0; i < n_stiffnesses; ++i) any = any || row[p * n_stiffnesses + i] != 0;
        if (!any) continue;
        of_packs<Real>(layout, use, k, j)[p] |= sends_springs;
        meets(k, j, p);
        meets(k, j + 1, p);
        for (int side = -1; side <= 1; ++side) meets(k + 1, j + side, p);
      }
    }
}
