// Part of kernels_source.hpp, in its namespace: the springs, a pack of nodes at a time.
#pragma once

/// Distances from a node to its neighbours along x, y and z at rest.
template<class Real>
SPRINGPROOF_INLINE Vec<Real> rest_edges(const Springs<Real>& s) {
  return {s.rest[edge_along[0]][0], s.rest[edge_along[1]][1], s.rest[edge_along[2]][2]};
}

// What a spring does to its ends, as functions of the vector d from one to the other, the change of d in some
// direction, the spring's numbers (k, say, a pack of each) and its place among the 13: the first end receives
// the result and the second one its opposite.

/// T/|d| d
template<class Laws, class Real>
struct Force {
  using P = Pack<Real>;
  static constexpr bool needs_direction = false;
  static constexpr int n_numbers = 1;
  Laws laws;
  SPRINGPROOF_INLINE Vec<P> operator()(const Vec<P>& d, const Vec<P>&, const Real* k, int spring) const {
    return laws.spring[spring].transverse(squared_length(d), load(k)) * d;
  }
};

/// Tangent times the change of d, for the first end.
template<class Laws, class Real, Clamp clamp>
struct Product {
  using P = Pack<Real>;
  static constexpr bool needs_direction = true;
  static constexpr int n_numbers = 1;
  Laws laws;
  SPRINGPROOF_INLINE Vec<P> operator()(const Vec<P>& d, const Vec<P>& change, const Real* k,
                                       int spring) const {
    const SpringTangent<P> tangent = laws.spring[spring].template tangent<clamp>(squared_length(d), load(k));
    return (-tangent.along * dot(d, change)) * d - tangent.transverse * change;
  }
};

/// The same for a kept tangent, whose numbers are those of SpringTangent.
template<class Real>
struct KeptProduct {
  using P = Pack<Real>;
  static constexpr bool needs_direction = true;
  static constexpr int n_numbers = 2;
  const Real* kept;
  SPRINGPROOF_INLINE Vec<P> operator()(const Vec<P>& d, const Vec<P>& change, const Real* tangent,
                                       int) const {
    return (-load(tangent + pack_size<Real>) * dot(d, change)) * d - load(tangent) * change;
  }
};

// The springs are swept in tiles: some packs of every row, plane after plane, in a scratch of whole packs on
// the boundaries of cache lines. For every pack of nodes it holds, one after the other:
//   displacements of the nodes before them in their row, of themselves, and of those after them, all taken
//   from the nodes' own places at rest (3 x 3 packs); the direction likewise, if there is one; and sums: what
//   goes to the nodes before, to the nodes, and to those after (3 x 3 packs), which fold() brings together.
// So whatever a spring needs is an aligned pack at a fixed distance from one of two addresses, its plane's
// and that of the plane above. A plane has one row more before its first and after its last.
template<class Action>
constexpr std::ptrdiff_t node_packs = Action::needs_direction ? 27 : 18;
template<class Action>
constexpr std::ptrdiff_t sums_at = Action::needs_direction ? 18 : 9;
constexpr std::ptrdiff_t direction_at = 9;

/// Three packs one after the other.
template<class Real>
SPRINGPROOF_INLINE Vec<Pack<Real>> load_three(const Real* from) {
  constexpr std::ptrdiff_t lanes = pack_size<Real>;
  return {load(from), load(from + lanes), load(from + 2 * lanes)};
}
template<class Real>
SPRINGPROOF_INLINE void store_three(Real* to, const Vec<Pack<Real>>& value) {
  constexpr std::ptrdiff_t lanes = pack_size<Real>;
  store(to, value.x);
  store(to + lanes, value.y);
  store(to + 2 * lanes, value.z);
}
template<class Real>
SPRINGPROOF_INLINE void clear_packs(Real* begin, std::ptrdiff_t n) {
  for (std::ptrdiff_t i = 0; i < n; ++i) store(begin + i * pack_size<Real>, Pack<Real>{});
}

template<class Action, class Real>
SPRINGPROOF_INLINE void clear_sums(Real* row, std::ptrdiff_t n) {
  for (std::ptrdiff_t p = 0; p < n; ++p)
    clear_packs(row + (p * node_packs<Action> + sums_at<Action>)*pack_size<Real>, 9);
}

/// Copies one vector field along a row into the scratch; h is what lies between neighbours. Packs that meet
/// no spring keep what is there, which no spring reads.
template<std::ptrdiff_t stride, class Real>
SPRINGPROOF_INLINE void unpack(const Real* from, std::ptrdiff_t distance, Real h, std::ptrdiff_t n,
                               const unsigned char* use, Real* to) {
  constexpr std::ptrdiff_t lanes = pack_size<Real>;
  for (std::ptrdiff_t p = 0; p < n; ++p) {
    if (use && !(use[p] & meets_springs)) continue;
    for (int c = 0; c < 3; ++c) {
      const Real* at = from + p * lanes + c * distance;
      Real* const out = to + (p * stride + c) * lanes;
      const Real step = c == 0 ? h : Real(0);
      store(out, load(at - 1) - step);
      store(out + 3 * lanes, load(at));
      store(out + 6 * lanes, load(at + 1) + step);
    }
  }
}

/// Sweeps one spring of a pack of nodes: the senders' sum grows, that of the nodes at the other end shrinks.
/// @param from  where the senders' places at rest are, seen from the other row's, less the senders'
/// displacement
/// @param to    the pack at the senders' place in the other row
template<int spring, class Real, class Action>
SPRINGPROOF_INLINE void sweep_spring(const Action& action, const Vec<Pack<Real>>& from,
                                     const Vec<Pack<Real>>& v, const Real* numbers, Real* to,
                                     Vec<Pack<Real>>& own) {
  using P = Pack<Real>;
  constexpr std::ptrdiff_t lanes = pack_size<Real>, side = 3 * (spring_steps[spring][0] + 1) * lanes;
  const Vec<P> d = load_three(to + side) + from;
  Vec<P> change{};
  if constexpr (Action::needs_direction) change = load_three(to + direction_at * lanes + side) - v;
  const Vec<P> f = action(d, change, numbers + spring * Action::n_numbers * lanes, spring);
  own = own + f;
  Real* const sum = to + sums_at<Action> * lanes + side;
  // Rows are swept upwards: nothing has come before to the row and plane after the senders'.
  if constexpr (spring_steps[spring][1] == 1 && spring_steps[spring][2] == 1)
    store_three(sum, Vec<P>{} - f);
  else
    store_three(sum, load_three(sum) - f);
}

/// Sweeps the three springs of a group.
/// @param edge  distances from a node to its neighbours along x, y, z at rest
template<int group, class Real, class Action>
SPRINGPROOF_INLINE void sweep_group(const Action& action, const Vec<Pack<Real>>& edge,
                                    const Vec<Pack<Real>>& u, const Vec<Pack<Real>>& v, const Real* numbers,
                                    Real* plane, Vec<Pack<Real>>& own) {
  constexpr int dy = spring_steps[3 * group][1], dz = spring_steps[3 * group][2];
  Vec<Pack<Real>> from = Vec<Pack<Real>>{} - u;
  if constexpr (dy != 0) from.y = (dy == 1 ? edge.y : -edge.y) - u.y;
  if constexpr (dz == 1) from.z = edge.z - u.z;
  Real* const to = plane + dy * tile * node_packs<Action> * pack_size<Real>;
  sweep_spring<3 * group>(action, from, v, numbers, to, own);
  sweep_spring<3 * group + 1>(action, from, v, numbers, to, own);
  sweep_spring<3 * group + 2>(action, from, v, numbers, to, own);
}

/// Sweeps all springs of a tile's packs in one row.
/// @tparam upwards  whether there is a plane above
/// @param all_numbers  blocks of those of a pack's springs
/// @param blocks       each pack's block; null: one after the other
/// @param use          each pack's use; null: all have springs
template<bool upwards, class Real, class Action>
SPRINGPROOF_INLINE void sweep_row(const Springs<Real>& s, const Action& action, const Real* all_numbers,
                                  const int* blocks, const unsigned char* use, Real* here, Real* above,
                                  std::ptrdiff_t n) {
  using P = Pack<Real>;
  constexpr std::ptrdiff_t lanes = pack_size<Real>;
  const Vec<Real> edges = rest_edges(s);
  const Vec<P> edge{P{} + edges.x, P{} + edges.y, P{} + edges.z};
  for (std::ptrdiff_t p = 0; p < n; ++p) {
    if (!use || (use[p] & sends_springs)) {
      const Real* const numbers =
          all_numbers + (blocks ? blocks[p] : p) * Action::n_numbers * stiffness_packs * lanes;
      const Vec<P> u = load_three(here + 3 * lanes);
      Vec<P> v{};
      if constexpr (Action::needs_direction) v = load_three(here + (direction_at + 3) * lanes);
      Real* const sum = here + (sums_at<Action> + 3) * lanes;
      Vec<P> own = load_three(sum);
      sweep_spring<n_springs - 1>(action, Vec<P>{} - u, v, numbers, here, own);
      if constexpr (upwards) {
        sweep_group<0>(action, edge, u, v, numbers, above, own);
        sweep_group<1>(action, edge, u, v, numbers, above, own);
        sweep_group<2>(action, edge, u, v, numbers, above, own);
      }
      sweep_group<3>(action, edge, u, v, numbers, here, own);
      store_three(sum, own);
    } else if constexpr (upwards) { // what group 2 sets
      clear_packs(above + (tile * node_packs<Action> + sums_at<Action>)*lanes, 9);
    }
    here += node_packs<Action> * lanes;
    above += node_packs<Action> * lanes;
  }
}

/// Makes the results of a tile's part of a row from its sums. What goes to the node after the tile is left
/// there for the next tile, which finds it; what goes to the node before it is added there.
/// @param result   begins at the tile's first node
/// @param n_nodes  number of nodes in the row from there on
/// @param use      each pack's use: where no spring is met the result stays as it is; null: all have springs
template<class Action, class Real>
SPRINGPROOF_INLINE void fold(const Tile& t, const Real* sums, Real* result, std::ptrdiff_t distance,
                             std::ptrdiff_t n_nodes, const unsigned char* use) {
  using P = Pack<Real>;
  constexpr std::ptrdiff_t lanes = pack_size<Real>;
  Vec<P> before{};
  if (t.first > 0)
    for (int c = 0; c < 3; ++c) {
      Real* const at = result + c * distance;
      before[c][lanes - 1] = at[0];
      at[-1] += sums[c * lanes];
    }
  for (std::ptrdiff_t p = 0; p < t.n; ++p, sums += node_packs<Action> * lanes) {
    if (use && !(use[p] & meets_springs)) {
      before = Vec<P>{};
      continue;
    }
    const Vec<P> left = load_three(sums), right = load_three(sums + 6 * lanes);
    const Vec<P> next = p + 1 < t.n ? load_three(sums + node_packs<Action> * lanes) : Vec<P>{};
    Vec<P> total = load_three(sums + 3 * lanes) + window(before, right, lanes - 1) + window(left, next, 1);
    before = right;
    for (int c = 0; c < 3; ++c) {
      Real* const to = result + p * lanes + c * distance;
      if ((p + 1) * lanes <= n_nodes)
        store(to, total[c]);
      else // what follows the row's end stays as it is
        store(to, first_of(n_nodes - p * lanes, total[c], load(to)));
    }
  }
  if (t.is_last) return;
  for (int c = 0; c < 3; ++c) result[t.n * lanes + c * distance] = before[c][lanes - 1];
}

template<class Real, class Action>
void sweep_tile(const Springs<Real>& s, const Slab<Real>& slab, const Tile& t, const Action& action,
                const Real* displacement, const Real* direction, Real* result) {
  constexpr std::ptrdiff_t lanes = pack_size<Real>, row = tile * node_packs<Action> * lanes,
                           stiffness_row = tile * stiffness_packs * lanes;
  const Layout& layout = s.layout;
  const int rows = layout.nodes[1];
  const std::ptrdiff_t plane = (rows + 2) * row, n_nodes = layout.nodes[0] - t.first * lanes;
  Real* const stiffness =
      slab.scratch + (64 - reinterpret_cast<std::size_t>(slab.scratch) % 64) / sizeof(Real);
  Real* const planes = stiffness + 3 * stiffness_row;
  const auto first_row = [&](int k) { return planes + (k - slab.first) % 2 * plane + row; };
  const auto use_of = [&](int k, int j) -> const unsigned char* {
    return s.packed ? of_packs<Real>(layout, s.pack_use, k, j) + t.first : nullptr;
  };
  const auto unpack_row = [&](int k, int j) {
    Real* const to = first_row(k) + j * row;
    const std::ptrdiff_t at = layout.at(0, j, k) + t.first * lanes;
    unpack<node_packs<Action>>(displacement + at, layout.size, s.rest[12][0], t.n, use_of(k, j), to);
    if constexpr (Action::needs_direction)
      unpack<node_packs<Action>>(direction + at, layout.size, Real(0), t.n, use_of(k, j),
                                 to + direction_at * lanes);
  };
  const auto fold_row = [&](int k, int j) {
    Real* const to = result_plane(layout, slab, result, k, 0) + j * layout.row + t.first * lanes;
    fold<Action>(t, first_row(k) + j * row + sums_at<Action> * lanes, to,
                 k < slab.last ? layout.size : layout.plane, n_nodes,
                 s.volume_stiffness ? nullptr : use_of(k, j)); // from what is there, cells' terms are taken
  };
  constexpr bool is_kept = Action::n_numbers == 2;
  // Without holes there are three kinds of rows in a plane, the first, the last and those between, which are
  // the same in all planes but the first and the last.
  const auto kind = [&](int j) { return j == 0 ? 0 : j == rows - 1 ? 2 : 1; };

  // Rows outside the body: they only meet springs of no stiffness, but must be numbers.
  for (int k = slab.first; k < slab.first + 2; ++k) {
    clear_packs(first_row(k) - row, row / lanes);
    clear_packs(first_row(k) + rows * row, row / lanes);
  }
  for (int j = 0; j < rows; ++j) {
    unpack_row(slab.first, j);
    clear_sums<Action>(first_row(slab.first) + j * row, t.n);
  }
  for (int k = slab.first; k < slab.last; ++k) {
    const bool upwards = k + 1 < layout.nodes[2];
    if (!is_kept && !s.packed && (k == slab.first || k == 1 || !upwards))
      for (int j = 0; j < rows; j = j == 1 && rows > 3 ? rows - 1 : j + 1)
        fill_stiffness(s, t, k, j, stiffness + kind(j) * stiffness_row);
    if (upwards) {
      clear_sums<Action>(first_row(k + 1), t.n);
      unpack_row(k + 1, 0);
    }
    for (int j = 0; j < rows; ++j) {
      const Real* of_row = s.packed ? s.packed : stiffness + kind(j) * stiffness_row;
      const int* blocks = s.packed ? of_packs<Real>(layout, s.block_of_pack, k, j) + t.first : nullptr;
      if constexpr (is_kept) {
        of_row = action.kept + 2 * (packed_row<Real>(layout, k, j) + t.first * stiffness_packs * lanes);
        blocks = nullptr;
      }
      Real *const here = first_row(k) + j * row, *const above = first_row(k + 1) + j * row;
      if (upwards) {
        if (j + 1 < rows) unpack_row(k + 1, j + 1);
        sweep_row<true>(s, action, of_row, blocks, use_of(k, j), here, above, t.n);
      } else {
        sweep_row<false>(s, action, of_row, blocks, use_of(k, j), here, above, t.n);
      }
      fold_row(k, j);
    }
  }
  if (slab.last < layout.nodes[2])
    for (int j = 0; j < rows; ++j) fold_row(slab.last, j);
}

/// The sum over all springs of action(d, change), added to the first end and taken from the other.
template<class Real, class Action>
void sweep_springs(const Springs<Real>& s, const Slab<Real>& slab, const Action& action,
                   const Real* displacement, const Real* direction, Real* result) {
  const std::ptrdiff_t n_packs = packs_of_row<Real>(s.layout), n_tiles = tiles_of_row(n_packs);
  for (std::ptrdiff_t t = 0; t < n_tiles; ++t) {
    const std::ptrdiff_t first = first_of_tile(n_packs, t), n = first_of_tile(n_packs, t + 1) - first;
    sweep_tile(s, slab, {first, n, t + 1 == n_tiles}, action, displacement, direction, result);
  }
}
