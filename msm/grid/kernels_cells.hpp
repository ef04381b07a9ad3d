// Part of kernels_source.hpp, in its namespace: the terms of the cells, of their volumes and midlines.
#pragma once

/// Nodes of a plane whose cells are swept before their forces are added up: what they give stays in the
/// first-level cache.
constexpr std::ptrdiff_t block = 64;

/// Neighbours of vertex a of a cell around the three faces at it, each seen from outside anticlockwise:
/// a, b, c, d.
constexpr int faces_at[8][3][3] = {{{4, 6, 2}, {1, 5, 4}, {2, 3, 1}}, {{3, 7, 5}, {5, 4, 0}, {0, 2, 3}},
                                   {{0, 4, 6}, {6, 7, 3}, {3, 1, 0}}, {{7, 5, 1}, {2, 6, 7}, {1, 0, 2}},
                                   {{6, 2, 0}, {0, 1, 5}, {5, 7, 6}}, {{1, 3, 7}, {4, 0, 1}, {7, 6, 4}},
                                   {{2, 0, 4}, {7, 3, 2}, {4, 5, 7}}, {{5, 1, 3}, {3, 2, 6}, {6, 4, 5}}};

/// dV/dx_a of the trilinear hexahedron: the volume under a bilinear face a, b, c, d, as seen from the origin,
/// is the mean of what its two triangulations give. The derivative with respect to a is the sum over the
/// faces at a of (b x c + c x d + b x d) / 12.
template<class Real>
SPRINGPROOF_INLINE void volume_gradients(const Vec<Real> (&x)[8], Vec<Real> (&g)[8]) {
#pragma GCC unroll 8
  for (int a = 0; a < 8; ++a) {
    Vec<Real> sum{0, 0, 0};
#pragma GCC unroll 3
    for (int f = 0; f < 3; ++f) {
      const Vec<Real>&b = x[faces_at[a][f][0]], &c = x[faces_at[a][f][1]], &d = x[faces_at[a][f][2]];
      sum = sum + cross(c, d - b) + cross(b, d);
    }
    g[a] = Real(1.0 / 12) * sum;
  }
}

/// The change of that along y: the form is bilinear.
template<class Real>
SPRINGPROOF_INLINE Vec<Real> volume_gradient_change(const Vec<Real> (&x)[8], const Vec<Real> (&y)[8], int a) {
  Vec<Real> sum{0, 0, 0};
#pragma GCC unroll 3
  for (int f = 0; f < 3; ++f) {
    const int b = faces_at[a][f][0], c = faces_at[a][f][1], d = faces_at[a][f][2];
    sum = sum + cross(y[c], x[d] - x[b]) + cross(x[c], y[d] - y[b]) + cross(y[b], x[d]) + cross(x[b], y[d]);
  }
  return Real(1.0 / 12) * sum;
}

/// The cells of a plane from some node on: their rows of nodes (j, k), (j+1, k), (j, k+1), (j+1, k+1), their
/// k_v/V0, and their edges at rest.
template<class Real>
struct Cells {
  Rows<Real> row[4];
  const Real* stiffness;
  const Real* midline[3];
  Vec<Real> edges;
  /// Values at the vertices less the first one's.
  SPRINGPROOF_INLINE void read(std::ptrdiff_t i, Vec<Real> (&x)[8]) const {
    const Vec<Real> origin = row[0].at(i);
    x[0] = {0, 0, 0};
#pragma GCC unroll 8
    for (int v = 1; v < 8; ++v) x[v] = row[v >> 1].at(i + (v & 1)) - origin;
  }
  /// Positions of the vertices from the displaced first one.
  SPRINGPROOF_INLINE void positions(std::ptrdiff_t i, Vec<Real> (&x)[8]) const {
    read(i, x);
#pragma GCC unroll 8
    for (int v = 1; v < 8; ++v)
      x[v] = x[v] + Vec<Real>{(v & 1) ? edges.x : 0, (v & 2) ? edges.y : 0, (v & 4) ? edges.z : 0};
  }
};

/// Returns the cells of plane k from the plane's node number `first` on.
template<class Real>
SPRINGPROOF_INLINE Cells<Real> cells_from(const Springs<Real>& s, const Real* field, std::ptrdiff_t first,
                                          int k) {
  const Layout& layout = s.layout;
  const std::ptrdiff_t here = layout.at(0, 0, k) + first, above = here + layout.plane;
  Cells<Real> cells{{rows(field, layout.size, here), rows(field, layout.size, here + layout.row),
                     rows(field, layout.size, above), rows(field, layout.size, above + layout.row)},
                    s.volume_stiffness + here,
                    {},
                    rest_edges(s)};
  for (int a = 0; a < 3 && s.midline[0]; ++a) cells.midline[a] = s.midline[a] + here;
  return cells;
}

/// A third of the sum of x . dV/dx: the volume is a cubic form.
template<class Real>
SPRINGPROOF_INLINE Real volume(const Vec<Real> (&x)[8], const Vec<Real> (&g)[8]) {
  Real sum = 0;
#pragma GCC unroll 8
  for (int v = 1; v < 8; ++v) sum += dot(x[v], g[v]);
  return sum * Real(1.0 / 3);
}

/// Four times the vectors between the centres of opposite faces, along x, y and z: sums of four edges.
template<class Real>
SPRINGPROOF_INLINE void fourfold_midlines(const Vec<Real> (&x)[8], Vec<Real> (&d)[3]) {
  const Vec<Real> low_front = x[0] + x[1], low_back = x[2] + x[3], high_front = x[4] + x[5],
                  high_back = x[6] + x[7];
  d[0] = (x[1] - x[0]) + (x[3] - x[2]) + ((x[5] - x[4]) + (x[7] - x[6]));
  d[1] = (low_back - low_front) + (high_back - high_front);
  d[2] = (high_front + high_back) - (low_front + low_back);
}
/// |d|² of such a vector's midline.
template<class Real>
SPRINGPROOF_INLINE Real squared_midline(const Vec<Real>& fourfold) {
  return Real(1. / 16) * squared_length(fourfold);
}

/// f[v] += what quarters of forces on the face at +a, and their opposites on the one at -a, give to a vertex.
template<class Real>
SPRINGPROOF_INLINE void add_from_midlines(const Vec<Real> (&quarters)[3], Vec<Real> (&f)[8]) {
  const Vec<Real>&x = quarters[0], &y = quarters[1], &z = quarters[2];
  const Vec<Real> sum = x + y, difference = x - y, nearer = sum + z, farther = sum - z;
  const Vec<Real> up = difference + z, down = difference - z, none{0, 0, 0};
  const Vec<Real> of_vertices[8] = {none - nearer,  down, none - up,   farther,
                                    none - farther, up,   none - down, nearer};
#pragma GCC unroll 8
  for (int v = 0; v < 8; ++v) f[v] = f[v] + of_vertices[v];
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
      for (int r = 0; r < 4; ++r)
        for (int c = 0; c < 3; ++c) {
          Real* __restrict out =
              result_plane(layout, slab, result, k + (r >> 1), c) + first + (r & 1) * layout.row;
          const Real* __restrict lower = b + (6 * r + c) * block, * __restrict upper = lower + 3 * block;
          for (std::ptrdiff_t i = 0; i < length; ++i) out[i] -= lower[i];
          for (std::ptrdiff_t i = 0; i < length; ++i) out[i + 1] -= upper[i];
        }
    }
}

template<class Real>
SPRINGPROOF_INLINE void store_vertices(Real* b, std::ptrdiff_t i, const Vec<Real> (&f)[8]) {
#pragma GCC unroll 8
  for (int v = 0; v < 8; ++v) {
    b[(3 * v) * block + i] = f[v].x;
    b[(3 * v + 1) * block + i] = f[v].y;
    b[(3 * v + 2) * block + i] = f[v].z;
  }
}

// Cells' terms are functions of their own: inlined behind the springs, their loops lose a third of their
// speed.
template<bool has_midlines, class Real, class Laws>
__attribute__((noinline)) void cell_force(const Springs<Real>& s, const Slab<Real>& slab, const Laws& laws,
                                          const Real* displacement, Real* force) {
  const auto action = [&](std::ptrdiff_t first, std::ptrdiff_t length, int k, Real* b) {
    const Cells<Real> cells = cells_from(s, displacement, first, k);
#pragma GCC ivdep
    for (std::ptrdiff_t i = 0; i < length; ++i) {
      Vec<Real> x[8], g[8];
      cells.positions(i, x);
      volume_gradients(x, g);
      const Real pressure = laws.volume.pressure(volume(x, g), cells.stiffness[i]);
#pragma GCC unroll 8
      for (int v = 0; v < 8; ++v) g[v] = pressure * g[v];
      if constexpr (has_midlines) {
        Vec<Real> d[3];
        fourfold_midlines(x, d);
#pragma GCC unroll 3
        for (int a = 0; a < 3; ++a)
          d[a] = (Real(1. / 16) *
                  laws.spring[edge_along[a]].transverse(squared_midline(d[a]), cells.midline[a][i])) *
                 d[a];
        add_from_midlines(d, g);
      }
      store_vertices(b, i, g);
    }
  };
  sweep_cells(s, slab, action, force);
}

// What a product needs of cells' tangents, from `first` in plane k on: as their laws give it, or as it is
// kept.
template<Clamp how, class Real, class Laws>
struct TangentByLaw {
  static constexpr Clamp clamp = how;
  const Laws& laws;
  struct OfPlane {
    const Laws& laws;
    const Cells<Real>& cells;
    SPRINGPROOF_INLINE Real slope(Real volume, std::ptrdiff_t i) const {
      return laws.volume.template slope<clamp>(volume, cells.stiffness[i]);
    }
    SPRINGPROOF_INLINE Real pressure(Real volume, std::ptrdiff_t i) const {
      return laws.volume.pressure(volume, cells.stiffness[i]);
    }
    SPRINGPROOF_INLINE SpringTangent<Real> midline(int a, Real squared, std::ptrdiff_t i) const {
      return laws.spring[edge_along[a]].template tangent<clamp>(squared, cells.midline[a][i]);
    }
  };
  SPRINGPROOF_INLINE OfPlane of_plane(const Cells<Real>& cells, const Layout&, std::ptrdiff_t, int) const {
    return {laws, cells};
  }
};
template<class Real>
struct KeptTangent {
  static constexpr Clamp clamp = Clamp::yes;
  const Real* kept;
  struct OfPlane {
    const Real* slopes;
    std::ptrdiff_t n;
    SPRINGPROOF_INLINE Real slope(Real, std::ptrdiff_t i) const { return slopes[i]; }
    SPRINGPROOF_INLINE SpringTangent<Real> midline(int a, Real, std::ptrdiff_t i) const {
      return {slopes[(2 * a + 1) * n + i], slopes[(2 * a + 2) * n + i]};
    }
  };
  SPRINGPROOF_INLINE OfPlane of_plane(const Cells<Real>&, const Layout& layout, std::ptrdiff_t first,
                                      int k) const {
    const std::ptrdiff_t n = cells_of_plane(layout);
    return {kept + kept_cells(layout) + kept_per_cell * n * k + first, n};
  }
};

/// Quarters of the forces of midlines along a motion: their tangents' products with it, negative.
/// @param x, y  the cell's positions and the motion of its vertices
template<class Real, class OfPlane>
SPRINGPROOF_INLINE void midline_products(const OfPlane& tangents, std::ptrdiff_t i, const Vec<Real> (&x)[8],
                                         const Vec<Real> (&y)[8], Vec<Real> (&c)[3]) {
  Vec<Real> d[3];
  fourfold_midlines(x, d);
  fourfold_midlines(y, c);
#pragma GCC unroll 3
  for (int a = 0; a < 3; ++a) {
    const auto [transverse, along] = tangents.midline(a, squared_midline(d[a]), i);
    c[a] = (Real(-1. / 256) * along * dot(d[a], c[a])) * d[a] - (Real(1. / 16) * transverse) * c[a];
  }
}

/// dp/dV g (g . v) + p (change of g along v), the second part only where the tangent is not clamped, and the
/// tangents of midlines.
template<bool has_midlines, class Real, class Tangent>
__attribute__((noinline)) void cell_product(const Springs<Real>& s, const Slab<Real>& slab,
                                            const Tangent& tangent, const Real* displacement,
                                            const Real* direction, Real* product) {
  constexpr Clamp clamp = Tangent::clamp;
  const auto action = [&](std::ptrdiff_t first, std::ptrdiff_t length, int k, Real* b) {
    const Cells<Real> cells = cells_from(s, displacement, first, k), w = cells_from(s, direction, first, k);
    const auto tangents = tangent.of_plane(cells, s.layout, first, k);
    // Midlines beside the volume take more registers than there are: in double precision they come first.
    constexpr bool come_first = has_midlines && sizeof(Real) == 8;
    alignas(64) Real pulls[come_first ? 9 * block : 1];
    if constexpr (come_first)
#pragma GCC ivdep
      for (std::ptrdiff_t i = 0; i < length; ++i) {
        Vec<Real> x[8], y[8], c[3];
        cells.positions(i, x);
        w.read(i, y);
        midline_products(tangents, i, x, y, c);
#pragma GCC unroll 3
        for (int a = 0; a < 3; ++a) {
          pulls[3 * a * block + i] = c[a].x;
          pulls[(3 * a + 1) * block + i] = c[a].y;
          pulls[(3 * a + 2) * block + i] = c[a].z;
        }
      }
#pragma GCC ivdep
    for (std::ptrdiff_t i = 0; i < length; ++i) {
      Vec<Real> x[8], g[8], y[8], f[8];
      cells.positions(i, x);
      w.read(i, y);
      volume_gradients(x, g);
      Real change = 0; // the gradients of a cell sum to 0: y may be taken from the first vertex
#pragma GCC unroll 8
      for (int v = 1; v < 8; ++v) change += dot(g[v], y[v]);
      const Real size = volume(x, g);
      change *= -tangents.slope(size, i); // sweep_cells subtracts
      Real pressure = 0;
      if constexpr (clamp == Clamp::no) pressure = -tangents.pressure(size, i);
#pragma GCC unroll 8
      for (int a = 0; a < 8; ++a) {
        if constexpr (clamp == Clamp::no)
          f[a] = change * g[a] + pressure * volume_gradient_change(x, y, a);
        else
          f[a] = change * g[a];
      }
      if constexpr (has_midlines) {
        Vec<Real> c[3];
        if constexpr (!come_first) midline_products(tangents, i, x, y, c);
#pragma GCC unroll 3
        for (int a = 0; a < 3 && come_first; ++a)
          c[a] = {pulls[3 * a * block + i], pulls[(3 * a + 1) * block + i], pulls[(3 * a + 2) * block + i]};
        add_from_midlines(c, f);
      }
      store_vertices(b, i, f);
    }
  };
  sweep_cells(s, slab, action, product);
}
