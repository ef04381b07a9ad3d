// The kernels' one source, compiled once per instruction set with SPRINGPROOF_ISA as the name of the set.
// It must include nothing that defines functions others share: the linker might keep the copy compiled for
// instructions that the machine lacks.
#include "msm/grid/kernels.hpp"

#include <immintrin.h> // intrinsics are always inlined: no shared functions

#define SPRINGPROOF_INLINE inline __attribute__((always_inline))

namespace msm::grid::SPRINGPROOF_ISA {

namespace {

// A pack is as many numbers as the instruction set computes at once.
#if defined(__AVX512F__)
#define SPRINGPROOF_PACK_BYTES 64
#elif defined(__AVX2__)
#define SPRINGPROOF_PACK_BYTES 32
#else
#define SPRINGPROOF_PACK_BYTES 16
#endif

template<class Real>
struct PackOf;
template<>
struct PackOf<double> {
  typedef double type __attribute__((vector_size(SPRINGPROOF_PACK_BYTES)));
  typedef double unaligned __attribute__((vector_size(SPRINGPROOF_PACK_BYTES), aligned(8), may_alias));
};
template<>
struct PackOf<float> {
  typedef float type __attribute__((vector_size(SPRINGPROOF_PACK_BYTES)));
  typedef float unaligned __attribute__((vector_size(SPRINGPROOF_PACK_BYTES), aligned(4), may_alias));
};
template<class Real>
using Pack = typename PackOf<Real>::type;
using PackD = Pack<double>;
using PackF = Pack<float>;

template<class Real>
constexpr std::ptrdiff_t pack_size = SPRINGPROOF_PACK_BYTES / sizeof(Real);

SPRINGPROOF_INLINE PackD load(const double* from) {
  return *reinterpret_cast<const PackOf<double>::unaligned*>(from);
}
SPRINGPROOF_INLINE PackF load(const float* from) {
  return *reinterpret_cast<const PackOf<float>::unaligned*>(from);
}
SPRINGPROOF_INLINE void store(double* to, const PackD& value) {
  *reinterpret_cast<PackOf<double>::unaligned*>(to) = value;
}
SPRINGPROOF_INLINE void store(float* to, const PackF& value) {
  *reinterpret_cast<PackOf<float>::unaligned*>(to) = value;
}

// 1/sqrt(x), x > 0, from the machine's estimate: of 1/sqrt(1 - e) with e = 1 - x y², as many terms of the
// series 1 + e/2 + 3/8 e² + ... as bring the estimate's 11.4 or 14 bits to the last digit of a double (1e-16)
// or float.
SPRINGPROOF_INLINE PackF inverse_root(const PackF& x) {
#if defined(__AVX512F__)
  const PackF y = _mm512_rsqrt14_ps(x);
#elif defined(__AVX2__)
  const PackF y = _mm256_rsqrt_ps(x);
#else
  const PackF y = _mm_rsqrt_ps(x);
#endif
  const PackF e = 1.0f - (x * y) * y;
  return y + (y * e) * (0.5f + 0.375f * e);
}
SPRINGPROOF_INLINE PackD inverse_root(const PackD& x) {
#if defined(__AVX512F__)
  const PackD y = _mm512_rsqrt14_pd(x);
  const PackD e = 1.0 - (x * y) * y;
  return y + (y * e) * (0.5 + e * (0.375 + 0.3125 * e));
#else
#if defined(__AVX2__)
  const PackD y = _mm256_cvtps_pd(_mm_rsqrt_ps(_mm256_cvtpd_ps(x)));
#else
  const PackD y = _mm_cvtps_pd(_mm_rsqrt_ps(_mm_cvtpd_ps(x)));
#endif
  const PackD e = 1.0 - (x * y) * y;
  return y + (y * e) * (0.5 + e * (0.375 + e * (0.3125 + 0.2734375 * e)));
#endif
}
/// The same one at a time, for loops that the compiler turns into packs.
SPRINGPROOF_INLINE double inverse_root(double x) {
  const float estimate = 1.0f / __builtin_sqrtf(static_cast<float>(x));
  const double y = static_cast<double>(estimate);
  const double error = 1 - x * y * y;
  return y + y * error * (0.5 + 0.375 * error);
}
SPRINGPROOF_INLINE float inverse_root(float x) {
  return 1.0f / __builtin_sqrtf(x);
}

template<class Real>
struct Vec {
  Real x, y, z;
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

template<class T>
struct Unqualified {
  using type = T;
};
template<class T>
struct Unqualified<const T> {
  using type = T;
};

/// Three arrays of one row.
template<class Real>
struct Rows {
  using Value = typename Unqualified<Real>::type;
  Real *x, *y, *z;
  SPRINGPROOF_INLINE Vec<Value> at(std::ptrdiff_t i) const { return {x[i], y[i], z[i]}; }
  SPRINGPROOF_INLINE void set(std::ptrdiff_t i, const Vec<Value>& v) const {
    x[i] = v.x;
    y[i] = v.y;
    z[i] = v.z;
  }
};
template<class Real>
SPRINGPROOF_INLINE Rows<Real> rows(Real* field, std::ptrdiff_t array, std::ptrdiff_t offset) {
  return {field + offset, field + array + offset, field + 2 * array + offset};
}

/// A spring's stiffness along the nodes of plane k: `share` times `scale`.
template<class Real>
struct Share {
  const Real* share;
  Real scale;
};

/// That of a group's first spring; the others of the group follow at a distance of layout.plane.
template<class Real>
SPRINGPROOF_INLINE Share<Real> spring_share(const Springs<Real>& s, int spring, int k) {
  const std::ptrdiff_t plane = s.layout.plane;
  if (s.by_node) return {s.by_node + (n_springs * k + spring) * plane, s.stiffness[spring]};
  const bool along_row = spring == n_springs - 1;
  const int dx = along_row ? 1 : spring % 3 - 1, dy = along_row ? 0 : group_dy[spring / 3],
            dz = along_row ? 0 : group_dz[spring / 3];
  return {s.share + (3 * (dy + 1) + dx + 1) * plane, s.stiffness[spring] * s.share_z[3 * k + dz + 1]};
}

template<class Real>
SPRINGPROOF_INLINE Vec<Real> rest_of(const Springs<Real>& s, int spring) {
  return {s.rest[spring][0], s.rest[spring][1], s.rest[spring][2]};
}

// What a spring does to its ends, as functions of the vector d from one to the other and the change of d in
// some direction: the first end receives the result and the second one its opposite.

/// k (1 - l0/|d|) d. A ghost may lie where a node is: hence the least length.
template<class Number, class Real>
SPRINGPROOF_INLINE Number tension(const Vec<Number>& d, const Number& k, Real rest_length,
                                  Number& inverse_length) {
  const Number squared = dot(d, d);
  const Number least = Number{} + Real(1e-30);
  inverse_length = inverse_root(squared > least ? squared : least);
  return k * (Real(1) - rest_length * inverse_length);
}

template<class Real>
struct Force {
  using P = Pack<Real>;
  static constexpr bool needs_direction = false;
  SPRINGPROOF_INLINE Vec<P> operator()(const Vec<P>& d, const Vec<P>&, const P& k, Real rest_length) const {
    P inverse_length;
    return tension(d, k, rest_length, inverse_length) * d;
  }
};

/// Tangent times the change c of d, for the first end: -(t c + (k - t) (d.c)/|d|² d) with t = k (1 - l0/|d|),
/// at least 0 when clamped.
template<class Real, Clamp clamp>
struct Product {
  using P = Pack<Real>;
  static constexpr bool needs_direction = true;
  SPRINGPROOF_INLINE Vec<P> operator()(const Vec<P>& d, const Vec<P>& change, const P& k,
                                       Real rest_length) const {
    P inverse_length;
    P t = tension(d, k, rest_length, inverse_length);
    if constexpr (clamp == Clamp::yes) t = t > Real(0) ? t : P{};
    const P along = (t - k) * (dot(d, change) * (inverse_length * inverse_length));
    return along * d - t * change;
  }
};

/// Three arrays at equal distances. The sweeps name them by one pointer and a few distances that all of them
/// share: a pointer for each would not fit into the machine's registers.
template<class Real>
SPRINGPROOF_INLINE Vec<Pack<Real>> load(const Real* from, std::ptrdiff_t distance) {
  return {load(from), load(from + distance), load(from + 2 * distance)};
}
template<class Real>
SPRINGPROOF_INLINE void store(Real* to, std::ptrdiff_t distance, const Vec<Pack<Real>>& value) {
  store(to, value.x);
  store(to + distance, value.y);
  store(to + 2 * distance, value.z);
}
template<class Real>
SPRINGPROOF_INLINE void add(Real* to, std::ptrdiff_t distance, const Vec<Pack<Real>>& value) {
  store(to, distance, load(to, distance) + value);
}
template<class Real>
SPRINGPROOF_INLINE void subtract(Real* to, std::ptrdiff_t distance, const Vec<Pack<Real>>& value) {
  store(to, distance, load(to, distance) - value);
}

/// Where the results of one plane add up, from its first node on, in arrays at a distance of layout.plane:
/// what goes to the node at the same place in the row goes to `middle`; what goes to the node before or after
/// it, to `left` or `right` at its sender's place, so that all accesses are aligned alike; fold() brings them
/// together.
template<class Real>
struct Sums {
  Real *left, *middle, *right;
};

/// Three springs of nodes first to last - 1 of a plane to three neighbours each in another row, which differ
/// in x alone; the first and the third are alike.
/// @param u, u_other  displacements from the plane's first node on, and from that node's second neighbour; v,
/// v_other: direction
template<class Real, class Action>
SPRINGPROOF_INLINE void sweep_group(const Springs<Real>& s, int group, int k, std::ptrdiff_t first,
                                    std::ptrdiff_t last, const Action& action, const Real* u,
                                    const Real* u_other, const Real* v, const Real* v_other, Real* own,
                                    const Sums<Real>& other) {
  using P = Pack<Real>;
  const std::ptrdiff_t size = s.layout.size, plane = s.layout.plane;
  const int spring = 3 * group;
  const Share<Real> side = spring_share(s, spring, k);
  const Real side_scale = side.scale, middle_scale = spring_share(s, spring + 1, k).scale;
  const Vec<Real> rest = rest_of(s, spring + 1);
  const Real h = s.rest[spring + 2][0], side_length = s.rest_length[spring],
             length = s.rest_length[spring + 1];
  for (std::ptrdiff_t i = first; i < last; i += pack_size<Real>) {
    const Vec<P> ui = load(u + i, size);
    const P y = rest.y - ui.y, z = rest.z - ui.z;
    Vec<P> vi{}, c0{}, c1{}, c2{};
    if constexpr (Action::needs_direction) {
      vi = load(v + i, size);
      c0 = load(v_other + i - 1, size) - vi;
      c1 = load(v_other + i, size) - vi;
      c2 = load(v_other + i + 1, size) - vi;
    }
    const Vec<P> before{-h - ui.x, y, z}, beside{-ui.x, y, z}, after{h - ui.x, y, z};
    const Vec<P> f0 =
        action(before + load(u_other + i - 1, size), c0, side_scale * load(side.share + i), side_length);
    subtract(other.left + i, plane, f0);
    const Vec<P> f1 =
        action(beside + load(u_other + i, size), c1, middle_scale * load(side.share + plane + i), length);
    subtract(other.middle + i, plane, f1);
    const Vec<P> f2 = action(after + load(u_other + i + 1, size), c2,
                             side_scale * load(side.share + 2 * plane + i), side_length);
    subtract(other.right + i, plane, f2);
    add(own + i, plane, f0 + f1 + f2);
  }
}

/// The springs along the rows.
template<class Real, class Action>
SPRINGPROOF_INLINE void sweep_row(const Springs<Real>& s, int k, std::ptrdiff_t first, std::ptrdiff_t last,
                                  const Action& action, const Real* u, const Real* v, const Sums<Real>& own) {
  using P = Pack<Real>;
  const std::ptrdiff_t size = s.layout.size, plane = s.layout.plane;
  const int spring = n_springs - 1;
  const Share<Real> share = spring_share(s, spring, k);
  const Real h = s.rest[spring][0], length = s.rest_length[spring];
  for (std::ptrdiff_t i = first; i < last; i += pack_size<Real>) {
    Vec<P> change{}, d = load(u + i + 1, size) - load(u + i, size);
    d.x = d.x + h;
    if constexpr (Action::needs_direction) change = load(v + i + 1, size) - load(v + i, size);
    const Vec<P> f = action(d, change, share.scale * load(share.share + i), length);
    add(own.middle + i, plane, f);
    subtract(own.right + i, plane, f);
  }
}

template<class Real>
SPRINGPROOF_INLINE void clear(Real* begin, std::ptrdiff_t n) {
  for (std::ptrdiff_t i = 0; i < n; ++i) begin[i] = 0;
}

/// The plane's results from its sums, which are cleared for the plane after the next.
template<class Real>
SPRINGPROOF_INLINE void fold(const Sums<Real>& sums, const Layout& layout, Real* result,
                             std::ptrdiff_t distance) {
  const std::ptrdiff_t n = layout.row * layout.nodes[1], plane = layout.plane;
  for (std::ptrdiff_t i = 0; i < n; i += pack_size<Real>)
    store(result + i, distance,
          load(sums.middle + i, plane) + load(sums.left + i + 1, plane) + load(sums.right + i - 1, plane));
  for (std::ptrdiff_t i = 0; i < n; i += pack_size<Real>) {
    store(sums.left + i, plane, Vec<Pack<Real>>{});
    store(sums.middle + i, plane, Vec<Pack<Real>>{});
    store(sums.right + i, plane, Vec<Pack<Real>>{});
  }
}

/// Nodes of a plane that are swept before the next group's turn: their rows stay in the first-level cache.
constexpr std::ptrdiff_t block = 64;

/// The sum over all springs of action(d, change), added to the first end and taken from the other.
template<class Real, class Action>
void sweep_springs(const Springs<Real>& s, const Slab<Real>& slab, const Action& action,
                   const Real* displacement, const Real* direction, Real* result) {
  const Layout& layout = s.layout;
  const std::ptrdiff_t n = layout.row * layout.nodes[1];
  clear(slab.scratch, scratch_size(layout));
  const auto sums_of = [&](int k) {
    Real* start = slab.scratch + ((k - slab.first) % 2) * 9 * layout.plane + layout.at(0, 0, -1);
    return Sums<Real>{start, start + 3 * layout.plane, start + 6 * layout.plane};
  };
  for (int k = slab.first; k < slab.last; ++k) {
    const Real *u = displacement + layout.at(0, 0, k), *v = direction + layout.at(0, 0, k);
    const Sums<Real> own = sums_of(k);
    for (std::ptrdiff_t first = 0; first < n; first += block) {
      const std::ptrdiff_t last = first + block < n ? first + block : n;
      sweep_row(s, k, first, last, action, u, v, own);
      for (int group = 0; group < n_groups; ++group) {
        const int up = group_dz[group];
        if (k + up >= layout.nodes[2]) continue;
        const std::ptrdiff_t row = group_dy[group] * layout.row, offset = row + up * layout.plane;
        const Sums<Real> other = sums_of(k + up);
        sweep_group(s, group, k, first, last, action, u, u + offset, v, v + offset, own.middle,
                    {other.left + row, other.middle + row, other.right + row});
      }
    }
    fold(own, layout, result + layout.at(0, 0, k), layout.size);
  }
  if (slab.last < layout.nodes[2])
    fold(sums_of(slab.last), layout, slab.spill + layout.at(0, 0, -1), layout.plane);
}

/// First node of plane k of the result: in the field, or in the spill.
template<class Real>
SPRINGPROOF_INLINE Rows<Real> result_plane(const Layout& layout, const Slab<Real>& slab, Real* field, int k) {
  if (k < slab.last) return rows(field, layout.size, layout.at(0, 0, k));
  return rows(slab.spill, layout.plane, layout.at(0, 0, -1));
}

template<class Real>
SPRINGPROOF_INLINE Rows<Real> shifted(const Rows<Real>& from, std::ptrdiff_t offset) {
  return {from.x + offset, from.y + offset, from.z + offset};
}

// ---- cell volume -----------------------------------------------------------------------------------------

/// Neighbours of vertex a of a cell around the three faces at it, each seen from outside anticlockwise:
/// a, b, c, d.
constexpr int faces_at[8][3][3] = {{{4, 6, 2}, {1, 5, 4}, {2, 3, 1}}, {{3, 7, 5}, {5, 4, 0}, {0, 2, 3}},
                                   {{0, 4, 6}, {6, 7, 3}, {3, 1, 0}}, {{7, 5, 1}, {2, 6, 7}, {1, 0, 2}},
                                   {{6, 2, 0}, {0, 1, 5}, {5, 7, 6}}, {{1, 3, 7}, {4, 0, 1}, {7, 6, 4}},
                                   {{2, 0, 4}, {7, 3, 2}, {4, 5, 7}}, {{5, 1, 3}, {3, 2, 6}, {6, 4, 5}}};

/// dV/dx_a of the trilinear hexahedron: the volume under a bilinear face a, b, c, d, as seen from the origin,
/// is the mean of what its two triangulations give; of its derivative with respect to a, the faces at a add
/// (b x c + c x d + b x d) / 12.
template<class Real, int a>
SPRINGPROOF_INLINE Vec<Real> volume_gradient(const Vec<Real> (&x)[8]) {
  Vec<Real> sum{0, 0, 0};
#pragma GCC unroll 3
  for (int f = 0; f < 3; ++f) {
    const Vec<Real>&b = x[faces_at[a][f][0]], &c = x[faces_at[a][f][1]], &d = x[faces_at[a][f][2]];
    sum = sum + cross(c, d - b) + cross(b, d);
  }
  return Real(1.0 / 12) * sum;
}

/// The change of that along y: the form is bilinear.
template<class Real, int a>
SPRINGPROOF_INLINE Vec<Real> volume_gradient_change(const Vec<Real> (&x)[8], const Vec<Real> (&y)[8]) {
  Vec<Real> sum{0, 0, 0};
#pragma GCC unroll 3
  for (int f = 0; f < 3; ++f) {
    const int b = faces_at[a][f][0], c = faces_at[a][f][1], d = faces_at[a][f][2];
    sum = sum + cross(y[c], x[d] - x[b]) + cross(x[c], y[d] - y[b]) + cross(y[b], x[d]) + cross(x[b], y[d]);
  }
  return Real(1.0 / 12) * sum;
}

template<class Real>
struct CellRows {
  Rows<const Real> row[4]; ///< (j, k), (j+1, k), (j, k+1), (j+1, k+1)
  SPRINGPROOF_INLINE void read(std::ptrdiff_t i, Vec<Real> (&x)[8]) const {
    const Vec<Real> origin = row[0].at(i);
    x[0] = {0, 0, 0};
    x[1] = row[0].at(i + 1) - origin;
    x[2] = row[1].at(i) - origin;
    x[3] = row[1].at(i + 1) - origin;
    x[4] = row[2].at(i) - origin;
    x[5] = row[2].at(i + 1) - origin;
    x[6] = row[3].at(i) - origin;
    x[7] = row[3].at(i + 1) - origin;
  }
};

/// Of the cells of plane k from node number `first` of the plane.
template<class Real>
SPRINGPROOF_INLINE CellRows<Real> cell_rows(const Layout& layout, const Real* field, std::ptrdiff_t first,
                                            int k) {
  const std::ptrdiff_t here = layout.at(0, 0, k) + first, above = here + layout.plane;
  return {{rows(field, layout.size, here), rows(field, layout.size, here + layout.row),
           rows(field, layout.size, above), rows(field, layout.size, above + layout.row)}};
}

/// Positions of a cell's vertices from the displaced first one.
template<class Real>
SPRINGPROOF_INLINE void cell_positions(const CellRows<Real>& u, std::ptrdiff_t i, const Vec<Real>& h,
                                       Vec<Real> (&x)[8]) {
  u.read(i, x);
#pragma GCC unroll 8
  for (int v = 1; v < 8; ++v)
    x[v] = x[v] + Vec<Real>{(v & 1) ? h.x : 0, (v & 2) ? h.y : 0, (v & 4) ? h.z : 0};
}

template<class Real>
SPRINGPROOF_INLINE void volume_gradients(const Vec<Real> (&x)[8], Vec<Real> (&g)[8]) {
  g[0] = volume_gradient<Real, 0>(x);
  g[1] = volume_gradient<Real, 1>(x);
  g[2] = volume_gradient<Real, 2>(x);
  g[3] = volume_gradient<Real, 3>(x);
  g[4] = volume_gradient<Real, 4>(x);
  g[5] = volume_gradient<Real, 5>(x);
  g[6] = volume_gradient<Real, 6>(x);
  g[7] = volume_gradient<Real, 7>(x);
}

/// A third of the sum of x . dV/dx: the volume is a cubic form.
template<class Real>
SPRINGPROOF_INLINE Real volume(const Vec<Real> (&x)[8], const Vec<Real> (&g)[8]) {
  Real sum = 0;
#pragma GCC unroll 8
  for (int v = 1; v < 8; ++v) sum += dot(x[v], g[v]);
  return sum * Real(1.0 / 3);
}

/// Edges of a cell at rest: springs 12 (x), 3*3+1 (y) and 3*1+1 (z).
template<class Real>
SPRINGPROOF_INLINE Vec<Real> cell_edges(const Springs<Real>& s) {
  return {s.rest[12][0], s.rest[10][1], s.rest[4][2]};
}

/// Nodes of the plane's rows that have cells above them, in whole packs: the last row has none.
SPRINGPROOF_INLINE std::ptrdiff_t cells_of_plane(const Layout& layout) {
  return (layout.row * (layout.nodes[1] - 1) + 15) / 16 * 16;
}

/// result -= what action gives for the eight vertices of every cell with a volume term.
template<class Real, class Action>
SPRINGPROOF_INLINE void sweep_cells(const Springs<Real>& s, const Slab<Real>& slab, const Action& action,
                                    Real* result) {
  const Layout& layout = s.layout;
  const std::ptrdiff_t n = cells_of_plane(layout);
  Real* const b = slab.scratch;
  for (int k = slab.first; k < slab.last && k + 1 < layout.nodes[2]; ++k)
    for (std::ptrdiff_t first = 0; first < n; first += block) {
      const std::ptrdiff_t length = first + block < n ? block : n - first;
      action(first, length, k, b);
      for (int r = 0; r < 4; ++r) {
        const Rows<Real> target =
            shifted(result_plane(layout, slab, result, k + (r >> 1)), first + (r & 1) * layout.row);
        Real* const component[3] = {target.x, target.y, target.z};
        for (int c = 0; c < 3; ++c) {
          Real* __restrict out = component[c];
          const Real* __restrict lower = b + (6 * r + c) * block, * __restrict upper =
                                                                      b + (6 * r + 3 + c) * block;
          for (std::ptrdiff_t i = 0; i < length; ++i) out[i] -= lower[i];
          for (std::ptrdiff_t i = 0; i < length; ++i) out[i + 1] -= upper[i];
        }
      }
    }
}

template<class Real>
SPRINGPROOF_INLINE void store(Real* b, std::ptrdiff_t i, const Vec<Real> (&f)[8]) {
#pragma GCC unroll 8
  for (int v = 0; v < 8; ++v) {
    b[(3 * v) * block + i] = f[v].x;
    b[(3 * v + 1) * block + i] = f[v].y;
    b[(3 * v + 2) * block + i] = f[v].z;
  }
}

template<class Real>
void volume_force(const Springs<Real>& s, const Slab<Real>& slab, const Real* displacement, Real* force) {
  const Vec<Real> h = cell_edges(s);
  const Real rest_volume = s.rest_volume;
  const auto action = [&](std::ptrdiff_t first, std::ptrdiff_t length, int k, Real* b) {
    const CellRows<Real> u = cell_rows(s.layout, displacement, first, k);
    const Real* stiffness = s.volume_stiffness + s.layout.at(0, 0, k) + first;
#pragma GCC ivdep
    for (std::ptrdiff_t i = 0; i < length; ++i) {
      Vec<Real> x[8], g[8];
      cell_positions(u, i, h, x);
      volume_gradients(x, g);
      const Real pressure = stiffness[i] * (volume(x, g) - rest_volume);
#pragma GCC unroll 8
      for (int v = 0; v < 8; ++v) g[v] = pressure * g[v];
      store(b, i, g);
    }
  };
  sweep_cells(s, slab, action, force);
}

/// k_v/V0 g (g . v) + p (change of g along v), the second part only where the tangent is not clamped.
template<class Real, Clamp clamp>
void volume_product(const Springs<Real>& s, const Slab<Real>& slab, const Real* displacement,
                    const Real* direction, Real* product) {
  const Vec<Real> h = cell_edges(s);
  const Real rest_volume = s.rest_volume;
  const auto action = [&](std::ptrdiff_t first, std::ptrdiff_t length, int k, Real* b) {
    const CellRows<Real> u = cell_rows(s.layout, displacement, first, k),
                         w = cell_rows(s.layout, direction, first, k);
    const Real* stiffness = s.volume_stiffness + s.layout.at(0, 0, k) + first;
#pragma GCC ivdep
    for (std::ptrdiff_t i = 0; i < length; ++i) {
      Vec<Real> x[8], g[8], y[8], f[8];
      cell_positions(u, i, h, x);
      w.read(i, y);
      volume_gradients(x, g);
      Real change = 0; // the gradients of a cell sum to 0: y may be taken from the first vertex
#pragma GCC unroll 8
      for (int v = 1; v < 8; ++v) change += dot(g[v], y[v]);
      change *= -stiffness[i]; // sweep_cells subtracts
      if constexpr (clamp == Clamp::no) {
        const Real pressure = stiffness[i] * (rest_volume - volume(x, g));
        f[0] = change * g[0] + pressure * volume_gradient_change<Real, 0>(x, y);
        f[1] = change * g[1] + pressure * volume_gradient_change<Real, 1>(x, y);
        f[2] = change * g[2] + pressure * volume_gradient_change<Real, 2>(x, y);
        f[3] = change * g[3] + pressure * volume_gradient_change<Real, 3>(x, y);
        f[4] = change * g[4] + pressure * volume_gradient_change<Real, 4>(x, y);
        f[5] = change * g[5] + pressure * volume_gradient_change<Real, 5>(x, y);
        f[6] = change * g[6] + pressure * volume_gradient_change<Real, 6>(x, y);
        f[7] = change * g[7] + pressure * volume_gradient_change<Real, 7>(x, y);
        store(b, i, f);
      } else {
#pragma GCC unroll 8
        for (int v = 0; v < 8; ++v) g[v] = change * g[v];
        store(b, i, g);
      }
    }
  };
  sweep_cells(s, slab, action, product);
}

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

} // namespace msm::grid::SPRINGPROOF_ISA
