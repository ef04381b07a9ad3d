// The kernels' one source, compiled once per instruction set with SPRINGPROOF_ISA as the name of the set.
// It must include nothing that defines functions others share: the linker might keep the copy compiled for
// instructions that the machine lacks.
#include "msm/grid/kernels.hpp"

#define SPRINGPROOF_INLINE inline __attribute__((always_inline))

namespace msm::grid::SPRINGPROOF_ISA {

namespace {

/// 1/sqrt(x) from an estimate in single precision and a step of third order, which leaves 1e-15 relative.
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

/// A spring's stiffness: `share` (times `scale`) along a row.
template<class Real>
struct Share {
  const Real* share;
  Real scale;
};

template<class Real>
SPRINGPROOF_INLINE Share<Real> spring_share(const Springs<Real>& s, int spring, int dx, int dy, int dz, int j,
                                            int k) {
  if (s.by_node[spring]) return {s.by_node[spring] + s.layout.at(0, j, k), s.stiffness[spring]};
  return {s.share_x[dx + 1], s.stiffness[spring] * s.share_y[dy + 1][j] * s.share_z[dz + 1][k]};
}

// What a spring does to its ends, as functions of the vector d from one to the other and the change of d in
// some direction: the first end receives the result and the second one its opposite.

/// k (1 - l0/|d|) d. A ghost may lie where a node is: hence the least length.
template<class Real>
SPRINGPROOF_INLINE Real tension(const Vec<Real>& d, Real k, Real rest_length, Real& inverse_length) {
  const Real squared = dot(d, d);
  inverse_length = inverse_root(squared > Real(1e-30) ? squared : Real(1e-30));
  return k - k * rest_length * inverse_length;
}

template<class Real>
struct Force {
  SPRINGPROOF_INLINE Vec<Real> operator()(const Vec<Real>& d, const Vec<Real>&, Real k,
                                          Real rest_length) const {
    Real inverse_length;
    return tension(d, k, rest_length, inverse_length) * d;
  }
};

/// Tangent times the change c of d, for the first end: -(t c + (k - t) (d.c)/|d|² d) with t = k (1 - l0/|d|),
/// at least `least` times k.
template<class Real>
struct Product {
  Real least;
  SPRINGPROOF_INLINE Vec<Real> operator()(const Vec<Real>& d, const Vec<Real>& change, Real k,
                                          Real rest_length) const {
    Real inverse_length;
    Real t = tension(d, k, rest_length, inverse_length);
    t = t > least * k ? t : least * k;
    const Real along = (t - k) * dot(d, change) * inverse_length * inverse_length;
    return along * d - t * change;
  }
};

/// Adds b of the nodes of one row to the neighbours in another: target[i + dx] -= b[dx][i].
template<class Real>
SPRINGPROOF_INLINE void scatter(std::ptrdiff_t n, const Real* __restrict left, const Real* __restrict middle,
                                const Real* __restrict right, Real* __restrict target) {
#pragma GCC ivdep
  for (std::ptrdiff_t i = 0; i < n; ++i) target[i] -= left[i + 1] + middle[i] + right[i - 1];
}

/// Three springs of every node of a row to three neighbours each in another row.
template<class Real, class Action>
SPRINGPROOF_INLINE void sweep_group(const Springs<Real>& s, int group, int j, int k, const Action& action,
                                    const Rows<const Real>& u, const Rows<const Real>& u_other,
                                    const Rows<const Real>& v, const Rows<const Real>& v_other,
                                    const Rows<Real>& own, const Rows<Real>& other, Real* scratch) {
  const std::ptrdiff_t n = s.layout.row, stride = n + 32;
  const int dy = group_dy[group], dz = group_dz[group], first = 3 * group;
  const Share<Real> k0 = spring_share(s, first, -1, dy, dz, j, k),
                    k1 = spring_share(s, first + 1, 0, dy, dz, j, k),
                    k2 = spring_share(s, first + 2, 1, dy, dz, j, k);
  const Vec<Real> d0{s.rest[first][0], s.rest[first][1], s.rest[first][2]},
      d1{s.rest[first + 1][0], s.rest[first + 1][1], s.rest[first + 1][2]},
      d2{s.rest[first + 2][0], s.rest[first + 2][1], s.rest[first + 2][2]};
  const Real l0 = s.rest_length[first], l1 = s.rest_length[first + 1], l2 = s.rest_length[first + 2];
  const Rows<Real> b0 = rows(scratch + 16, stride, 0), b1 = rows(scratch + 16, stride, 3 * stride),
                   b2 = rows(scratch + 16, stride, 6 * stride);
#pragma GCC ivdep
  for (std::ptrdiff_t i = 0; i < n; ++i) {
    const Vec<Real> ui = u.at(i), vi = v.at(i);
    const Vec<Real> f0 =
        action(d0 + (u_other.at(i - 1) - ui), v_other.at(i - 1) - vi, k0.scale * k0.share[i], l0);
    const Vec<Real> f1 = action(d1 + (u_other.at(i) - ui), v_other.at(i) - vi, k1.scale * k1.share[i], l1);
    const Vec<Real> f2 =
        action(d2 + (u_other.at(i + 1) - ui), v_other.at(i + 1) - vi, k2.scale * k2.share[i], l2);
    b0.set(i, f0);
    b1.set(i, f1);
    b2.set(i, f2);
    own.set(i, own.at(i) + (f0 + f1 + f2));
  }
  scatter(n, b0.x, b1.x, b2.x, other.x);
  scatter(n, b0.y, b1.y, b2.y, other.y);
  scatter(n, b0.z, b1.z, b2.z, other.z);
}

/// The springs along a row.
template<class Real, class Action>
SPRINGPROOF_INLINE void sweep_row(const Springs<Real>& s, int j, int k, const Action& action,
                                  const Rows<const Real>& u, const Rows<const Real>& v, const Rows<Real>& own,
                                  Real* scratch) {
  const std::ptrdiff_t n = s.layout.row, stride = n + 32;
  const Share<Real> share = spring_share(s, 12, 1, 0, 0, j, k);
  const Vec<Real> d{s.rest[12][0], s.rest[12][1], s.rest[12][2]};
  const Real l = s.rest_length[12];
  const Rows<Real> b = rows(scratch + 16, stride, 0);
#pragma GCC ivdep
  for (std::ptrdiff_t i = 0; i < n; ++i)
    b.set(i, action(d + (u.at(i + 1) - u.at(i)), v.at(i + 1) - v.at(i), share.scale * share.share[i], l));
#pragma GCC ivdep
  for (std::ptrdiff_t i = 0; i < n; ++i) own.set(i, own.at(i) + (b.at(i) - b.at(i - 1)));
}

template<class Real>
SPRINGPROOF_INLINE void clear(Real* begin, std::ptrdiff_t n) {
  for (std::ptrdiff_t i = 0; i < n; ++i) begin[i] = 0;
}

/// Clears what a slab writes to: `components` arrays of its planes, and its spill.
template<class Real>
void clear_slab(const Layout& layout, const Slab<Real>& slab, int components, Real* field) {
  for (int c = 0; c < components; ++c)
    clear(field + c * layout.size + layout.at(0, 0, slab.first) - 16,
          layout.at(0, 0, slab.last) - layout.at(0, 0, slab.first));
  clear(slab.spill, components * layout.plane);
  clear(slab.scratch, scratch_size(layout));
}

/// Row (j, k) of the result: in the field, or in the spill.
template<class Real>
SPRINGPROOF_INLINE Rows<Real> result_rows(const Layout& layout, const Slab<Real>& slab, Real* field, int j,
                                          int k) {
  if (k < slab.last) return rows(field, layout.size, layout.at(0, j, k));
  return rows(slab.spill, layout.plane, layout.at(0, j, -1));
}

/// Adds action(d, change) of every spring to its first end and takes it from the other.
template<class Real, class Action>
void sweep_springs(const Springs<Real>& s, const Slab<Real>& slab, const Action& action,
                   const Real* displacement, const Real* direction, Real* result) {
  const Layout& layout = s.layout;
  const auto row_of = [&](const Real* field, int j, int k) {
    return rows(field, layout.size, layout.at(0, j, k));
  };
  for (int k = slab.first; k < slab.last; ++k)
    for (int j = 0; j < layout.nodes[1]; ++j) {
      const Rows<const Real> u = row_of(displacement, j, k), v = row_of(direction, j, k);
      const Rows<Real> own = result_rows(layout, slab, result, j, k);
      sweep_row(s, j, k, action, u, v, own, slab.scratch);
      for (int group = 0; group < n_groups; ++group) {
        const int j2 = j + group_dy[group], k2 = k + group_dz[group];
        if (j2 < 0 || j2 >= layout.nodes[1] || k2 >= layout.nodes[2]) continue;
        sweep_group(s, group, j, k, action, u, row_of(displacement, j2, k2), v, row_of(direction, j2, k2),
                    own, result_rows(layout, slab, result, j2, k2), slab.scratch);
      }
    }
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

template<class Real>
SPRINGPROOF_INLINE CellRows<Real> cell_rows(const Layout& layout, const Real* field, int j, int k) {
  return {{rows(field, layout.size, layout.at(0, j, k)), rows(field, layout.size, layout.at(0, j + 1, k)),
           rows(field, layout.size, layout.at(0, j, k + 1)),
           rows(field, layout.size, layout.at(0, j + 1, k + 1))}};
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

/// result -= what action gives for the eight vertices of every cell with a volume term.
template<class Real, class Action>
SPRINGPROOF_INLINE void sweep_cells(const Springs<Real>& s, const Slab<Real>& slab, const Action& action,
                                    Real* result) {
  const Layout& layout = s.layout;
  const std::ptrdiff_t n = layout.row, stride = n + 32;
  Real* const b = slab.scratch + 16;
  for (int k = slab.first; k < slab.last && k + 1 < layout.nodes[2]; ++k)
    for (int j = 0; j + 1 < layout.nodes[1]; ++j) {
      action(j, k, b, stride);
      for (int r = 0; r < 4; ++r) {
        const Rows<Real> target = result_rows(layout, slab, result, j + (r & 1), k + (r >> 1));
        Real* const component[3] = {target.x, target.y, target.z};
        for (int c = 0; c < 3; ++c) {
          Real* __restrict out = component[c];
          const Real* __restrict lower = b + (6 * r + c) * stride, * __restrict upper =
                                                                       b + (6 * r + 3 + c) * stride;
#pragma GCC ivdep
          for (std::ptrdiff_t i = 0; i < n; ++i) out[i] -= lower[i] + upper[i - 1];
        }
      }
    }
}

template<class Real>
SPRINGPROOF_INLINE void store(Real* b, std::ptrdiff_t stride, std::ptrdiff_t i, const Vec<Real> (&f)[8]) {
#pragma GCC unroll 8
  for (int v = 0; v < 8; ++v) {
    b[(3 * v) * stride + i] = f[v].x;
    b[(3 * v + 1) * stride + i] = f[v].y;
    b[(3 * v + 2) * stride + i] = f[v].z;
  }
}

template<class Real>
void volume_force(const Springs<Real>& s, const Slab<Real>& slab, const Real* displacement, Real* force) {
  const Vec<Real> h = cell_edges(s);
  const Real rest_volume = s.rest_volume;
  const auto action = [&](int j, int k, Real* b, std::ptrdiff_t stride) {
    const CellRows<Real> u = cell_rows(s.layout, displacement, j, k);
    const Real* stiffness = s.volume_stiffness + s.layout.at(0, j, k);
#pragma GCC ivdep
    for (std::ptrdiff_t i = 0; i < s.layout.row; ++i) {
      Vec<Real> x[8], g[8];
      cell_positions(u, i, h, x);
      volume_gradients(x, g);
      const Real pressure = stiffness[i] * (volume(x, g) - rest_volume);
#pragma GCC unroll 8
      for (int v = 0; v < 8; ++v) g[v] = pressure * g[v];
      store(b, stride, i, g);
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
  const auto action = [&](int j, int k, Real* b, std::ptrdiff_t stride) {
    const CellRows<Real> u = cell_rows(s.layout, displacement, j, k),
                         w = cell_rows(s.layout, direction, j, k);
    const Real* stiffness = s.volume_stiffness + s.layout.at(0, j, k);
#pragma GCC ivdep
    for (std::ptrdiff_t i = 0; i < s.layout.row; ++i) {
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
        store(b, stride, i, f);
      } else {
#pragma GCC unroll 8
        for (int v = 0; v < 8; ++v) g[v] = change * g[v];
        store(b, stride, i, g);
      }
    }
  };
  sweep_cells(s, slab, action, product);
}

// ---- the four kernels ------------------------------------------------------------------------------------

template<class Real>
void force(const Springs<Real>& s, const Slab<Real>& slab, const Real* displacement, Real* result) {
  clear_slab(s.layout, slab, 3, result);
  sweep_springs(s, slab, Force<Real>{}, displacement, displacement, result);
  if (s.volume_stiffness) volume_force(s, slab, displacement, result);
}

template<class Real>
void product(const Springs<Real>& s, const Slab<Real>& slab, Clamp clamp, const Real* displacement,
             const Real* direction, Real* result) {
  clear_slab(s.layout, slab, 3, result);
  const Real least = clamp == Clamp::yes ? Real(0) : Real(-1e30);
  sweep_springs(s, slab, Product<Real>{least}, displacement, direction, result);
  if (!s.volume_stiffness) return;
  if (clamp == Clamp::yes)
    volume_product<Real, Clamp::yes>(s, slab, displacement, direction, result);
  else
    volume_product<Real, Clamp::no>(s, slab, displacement, direction, result);
}

template<class Real>
double energy(const Springs<Real>& s, int first, int last, const Real* displacement) {
  const Layout& layout = s.layout;
  double total = 0;
  const auto row_of = [&](int j, int k) { return rows(displacement, layout.size, layout.at(0, j, k)); };
  for (int k = first; k < last; ++k)
    for (int j = 0; j < layout.nodes[1]; ++j) {
      const Rows<const Real> u = row_of(j, k);
      for (int spring = 0; spring < n_springs; ++spring) {
        const int dy = spring == 12 ? 0 : group_dy[spring / 3], dz = spring == 12 ? 0 : group_dz[spring / 3],
                  dx = spring == 12 ? 1 : spring % 3 - 1;
        if (j + dy < 0 || j + dy >= layout.nodes[1] || k + dz >= layout.nodes[2]) continue;
        const Rows<const Real> other = row_of(j + dy, k + dz);
        const Share<Real> share = spring_share(s, spring, dx, dy, dz, j, k);
        const Vec<Real> d{s.rest[spring][0], s.rest[spring][1], s.rest[spring][2]};
        const Real l0 = s.rest_length[spring];
        Real sum = 0;
        for (std::ptrdiff_t i = 0; i < layout.row; ++i) {
          const Vec<Real> now = d + (other.at(i + dx) - u.at(i));
          const Real squared = dot(now, now);
          const Real elongation = squared * inverse_root(squared > Real(1e-30) ? squared : Real(1e-30)) - l0;
          sum += share.share[i] * elongation * elongation;
        }
        total += 0.5 * static_cast<double>(share.scale) * static_cast<double>(sum);
      }
      if (!s.volume_stiffness || j + 1 == layout.nodes[1] || k + 1 == layout.nodes[2]) continue;
      const CellRows<Real> cell = cell_rows(layout, displacement, j, k);
      const Real* stiffness = s.volume_stiffness + layout.at(0, j, k);
      const Vec<Real> h = cell_edges(s);
      Real sum = 0;
      for (std::ptrdiff_t i = 0; i < layout.row; ++i) {
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
  clear_slab(layout, slab, 6, result);
  const Real least = clamp == Clamp::yes ? Real(0) : Real(-1e30);
  const auto target = [&](int j, int k, int c) {
    return k < slab.last ? result + c * layout.size + layout.at(0, j, k)
                         : slab.spill + c * layout.plane + layout.at(0, j, -1);
  };
  const std::ptrdiff_t stride = layout.row + 32;
  Real* const b = slab.scratch + 16;
  for (int k = slab.first; k < slab.last; ++k)
    for (int j = 0; j < layout.nodes[1]; ++j) {
      const Rows<const Real> u = rows(displacement, layout.size, layout.at(0, j, k));
      for (int spring = 0; spring < n_springs; ++spring) {
        const int dy = spring == 12 ? 0 : group_dy[spring / 3], dz = spring == 12 ? 0 : group_dz[spring / 3],
                  dx = spring == 12 ? 1 : spring % 3 - 1;
        if (j + dy < 0 || j + dy >= layout.nodes[1] || k + dz >= layout.nodes[2]) continue;
        const Rows<const Real> other = rows(displacement, layout.size, layout.at(0, j + dy, k + dz));
        const Share<Real> share = spring_share(s, spring, dx, dy, dz, j, k);
        const Vec<Real> d{s.rest[spring][0], s.rest[spring][1], s.rest[spring][2]};
        const Real l0 = s.rest_length[spring];
#pragma GCC ivdep
        for (std::ptrdiff_t i = 0; i < layout.row; ++i) {
          const Vec<Real> now = d + (other.at(i + dx) - u.at(i));
          const Real stiffness = share.scale * share.share[i];
          Real inverse_length;
          Real t = tension(now, stiffness, l0, inverse_length);
          t = t > least * stiffness ? t : least * stiffness;
          const Real along = (stiffness - t) * inverse_length * inverse_length;
          b[i] = t + along * now.x * now.x;
          b[i + stride] = t + along * now.y * now.y;
          b[i + 2 * stride] = t + along * now.z * now.z;
          b[i + 3 * stride] = along * now.y * now.z;
          b[i + 4 * stride] = along * now.x * now.z;
          b[i + 5 * stride] = along * now.x * now.y;
        }
        for (int c = 0; c < 6; ++c) {
          Real *own = target(j, k, c), *far = target(j + dy, k + dz, c);
          for (std::ptrdiff_t i = 0; i < layout.row; ++i) own[i] += b[i + c * stride];
          for (std::ptrdiff_t i = 0; i < layout.row; ++i) far[i] += b[i - dx + c * stride];
        }
      }
      if (!s.volume_stiffness || j + 1 == layout.nodes[1] || k + 1 == layout.nodes[2]) continue;
      const CellRows<Real> cell = cell_rows(layout, displacement, j, k);
      const Real* stiffness = s.volume_stiffness + layout.at(0, j, k);
      const Vec<Real> h = cell_edges(s);
      for (std::ptrdiff_t i = 0; i + 1 < layout.nodes[0]; ++i) {
        Vec<Real> x[8], g[8];
        cell_positions(cell, i, h, x);
        volume_gradients(x, g);
        for (int v = 0; v < 8; ++v) {
          const Real products[6] = {g[v].x * g[v].x, g[v].y * g[v].y, g[v].z * g[v].z,
                                    g[v].y * g[v].z, g[v].x * g[v].z, g[v].x * g[v].y};
          for (int c = 0; c < 6; ++c)
            target(j + ((v >> 1) & 1), k + (v >> 2), c)[i + (v & 1)] += stiffness[i] * products[c];
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
