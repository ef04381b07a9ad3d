#include "msm/grid/spring_field.hpp"

#include "cases/mesh/mesh.hpp"
#include "mechanics/grid/cycle.hpp"
#include "msm/grid/cell_tangent.hpp"

#include <string_view>
#include <unordered_map>

namespace springproof::msm::grid {

namespace {

using cases::index;

/// Stiffness of the spring of one cell that leads along a step.
double stiffness_along(const CellSprings& cell, const int (&step)[3]) {
  return stiffness_across(cell, (step[0] != 0) + 2 * (step[1] != 0) + 4 * (step[2] != 0));
}

Eigen::Vector3i vertex_of_cell(int v) {
  return {v & 1, (v >> 1) & 1, v >> 2};
}

} // namespace

template<class Real>
SpringField<Real>::SpringField(const Body& body, int n_threads)
    : body_(body), n_threads_(n_threads), springs_{} {
  springs_.layout = body.layout;
  springs_.rest_volume = static_cast<Real>(body.spacing.prod());
  springs_.law = kind_of(body.exponents);
  for (int s = 0; s < n_springs; ++s) {
    const Eigen::Vector3d rest =
        Eigen::Map<const Eigen::Vector3i>(spring_steps[s]).cast<double>().cwiseProduct(body.spacing);
    Eigen::Map<Eigen::Matrix<Real, 3, 1>>(springs_.rest[s]) = rest.cast<Real>();
    springs_.rest_length[s] = static_cast<Real>(rest.norm());
    const auto& [x, y, z] = spring_steps[s];
    springs_.parameter[s] =
        static_cast<Real>(law_of(body.exponents, (x != 0) + (y != 0) + (z != 0)).parameter);
  }
  if (body.is_uniform())
    set_shares();
  else
    set_by_node();
  const auto by_cell = [&](const auto& value) -> const Real* {
    Field<Real>& all = arrays_.emplace_back(Field<Real>::Zero(body.layout.size));
    for_each_place(body.cells, [&](int i, int j, int k) {
      all[body.layout.at(i, j, k)] = static_cast<Real>(value(body.cell(i, j, k)));
    });
    return all.data();
  };
  const auto has_any = [&](const auto& is_there) {
    return std::any_of(body.springs.begin(), body.springs.end(), is_there);
  };
  const bool has_midlines =
      has_any([](const CellSprings& cell) { return cell.midline != std::array<double, 3>{}; });
  if (has_midlines || has_any([](const CellSprings& cell) { return cell.volume != 0; }))
    springs_.volume_stiffness =
        by_cell([&](const CellSprings& cell) { return cell.volume / body.spacing.prod(); });
  const bool are_equal = !has_any([](const CellSprings& cell) {
    return cell.midline[1] != cell.midline[0] || cell.midline[2] != cell.midline[0];
  });
  for (std::size_t a = 0; a < 3 && has_midlines; ++a)
    springs_.midline[a] = a > 0 && are_equal
                              ? springs_.midline[0]
                              : by_cell([&](const CellSprings& cell) { return cell.midline[a]; });
  Field<Real>& counted = arrays_.emplace_back(Field<Real>::Zero(body.layout.plane));
  for (int j = 0; j < body.layout.nodes[1]; ++j)
    for (int i = 0; i < body.layout.nodes[0]; ++i)
      if (!body.part || body.part->owns(i, j, body.part->own_first[2])) counted[i + body.layout.row * j] = 1;
  springs_.counted = counted.data();
  is_constrained_.resize(index(3 * body.layout.size));
  for (const std::ptrdiff_t entry : body.constrained) {
    is_constrained_[index(entry)] = true;
    const auto [i, j, k, c] = body.layout.place(entry);
    if (body.part || has_cell(body, i, j, k)) held_.push_back(entry);
  }
  // Slabs of some sixteen planes of nodes: the same on any number of threads, so that sums are too, and an
  // even number, so that two threads have the same to do.
  const int planes = body.layout.nodes[2], n = planes < 8 ? 1 : 2 * std::max(1, planes / 16);
  const auto first_plane = [&](int slab) { return static_cast<int>(std::ptrdiff_t{slab} * planes / n); };
  for (int slab = 0; slab < n; ++slab) {
    auto& spill =
        arrays_.emplace_back(Field<Real>::Zero(6 * body.layout.plane + body.layout.at(0, 0, -1) + 32));
    auto& scratch = arrays_.emplace_back(Field<Real>::Zero(scratch_size(body.layout)));
    slabs_.push_back({first_plane(slab), first_plane(slab + 1), spill.data(), scratch.data()});
  }
  energy_of_slab_.resize(slabs_.size());
}

template<class Real>
void SpringField<Real>::set_shares() {
  for (int s = 0; s < n_springs; ++s)
    springs_.stiffness[s] = static_cast<Real>(stiffness_along(body_.springs.front(), spring_steps[s]));
  const Layout& layout = springs_.layout;
  const auto share_along = [&](int axis, int d, int i) {
    const int n = layout.nodes[axis];
    if (d == 0) return Real(i == 0 || i == n - 1 ? 1 : 2);
    return Real(i + d >= 0 && i + d < n ? 1 : 0);
  };
  Field<Real>& share = arrays_.emplace_back(Field<Real>::Zero(9 * layout.plane));
  Field<Real>& share_z = arrays_.emplace_back(3 * layout.nodes[2]);
  for (int d = -1; d <= 1; ++d) {
    for (int k = 0; k < layout.nodes[2]; ++k) share_z[3 * k + d + 1] = share_along(2, d, k);
    for (int e = -1; e <= 1; ++e)
      for (int j = 0; j < layout.nodes[1]; ++j)
        for (int i = 0; i < layout.nodes[0]; ++i)
          share[(3 * (e + 1) + d + 1) * layout.plane + i + layout.row * j] =
              share_along(0, d, i) * share_along(1, e, j);
  }
  springs_.share = share.data();
  springs_.share_z = share_z.data();
}

/// A spring gets what every cell with both its ends brings.
template<class Real>
void SpringField<Real>::set_by_node() {
  const Layout& layout = springs_.layout;
  Field<Real>& stiffness =
      arrays_.emplace_back(Field<Real>::Zero(n_springs * layout.nodes[2] * layout.plane));
  springs_.by_node = stiffness.data();
  for (int s = 0; s < n_springs; ++s) {
    springs_.stiffness[s] = 1;
    const auto& step = spring_steps[s];
    const auto lowest = [](int d) { return d > 0 ? 0 : -1; }; // cells with both ends along an axis: these ...
    const auto highest = [](int d) { return d < 0 ? -1 : 0; }; // ... to these, counted from the node
    for_each_place(layout.nodes, [&](int i, int j, int k) {
      double sum = 0;
      for (int c = lowest(step[2]); c <= highest(step[2]); ++c)
        for (int b = lowest(step[1]); b <= highest(step[1]); ++b)
          for (int a = lowest(step[0]); a <= highest(step[0]); ++a)
            sum += stiffness_along(body_.cell(i + a, j + b, k + c), step);
      stiffness[(n_springs * k + s) * layout.plane + i + layout.row * j] = static_cast<Real>(sum);
    });
  }
  pack_stiffness();
}

/// A block of stiffnesses is kept once, where the sweeps come to it first: inside a body all packs have the
/// same, and what would be read from memory stays in the cache.
template<class Real>
void SpringField<Real>::pack_stiffness() {
  const Layout& layout = springs_.layout;
  Field<Real> all(packed_size(layout));
  pack_use_.resize(index(pack_use_size(layout)));
  kernels<Real>().pack_stiffness(springs_, all.data(), pack_use_.data());
  const std::ptrdiff_t pack = kernels<Real>().pack, n_packs = (layout.nodes[0] + pack - 1) / pack,
                       n_rows = std::ptrdiff_t{layout.nodes[2]} * layout.nodes[1], block = n_springs * pack;
  const auto bytes = [&](std::ptrdiff_t p) {
    return std::string_view(reinterpret_cast<const char*>(all.data() + p * block),
                            index(block) * sizeof(Real));
  };
  block_of_pack_.resize(index(n_rows * n_packs));
  std::unordered_map<std::string_view, int> number;
  std::vector<std::ptrdiff_t> first_pack; // first pack with each block
  for (std::ptrdiff_t t = 0; t < tiles_of_row(n_packs); ++t)
    for (std::ptrdiff_t row = 0; row < n_rows; ++row)
      for (std::ptrdiff_t p = first_of_tile(n_packs, t); p < first_of_tile(n_packs, t + 1); ++p) {
        const std::ptrdiff_t at = row * n_packs + p;
        const auto [found, is_new] = number.try_emplace(bytes(at), static_cast<int>(number.size()));
        if (is_new) first_pack.push_back(at);
        block_of_pack_[index(at)] = found->second;
      }
  const auto n_blocks = static_cast<std::ptrdiff_t>(first_pack.size());
  Real* const start = add_array(n_blocks * block);
  for (std::ptrdiff_t b = 0; b < n_blocks; ++b)
    std::copy_n(all.data() + first_pack[index(b)] * block, block, start + b * block);
  springs_.packed = start;
  springs_.block_of_pack = block_of_pack_.data();
  springs_.pack_use = pack_use_.data();
}

/// Returns n zeros that begin on the boundary of a cache line.
template<class Real>
Real* SpringField<Real>::add_array(std::ptrdiff_t n) {
  constexpr std::ptrdiff_t line = 64 / sizeof(Real); // numbers in a cache line
  Field<Real>& room = arrays_.emplace_back(Field<Real>::Zero(n + line));
  const auto at = reinterpret_cast<std::size_t>(room.data()) / sizeof(Real);
  return room.data() + (line - static_cast<std::ptrdiff_t>(at) % line) % line;
}

template<class Real>
bool SpringField<Real>::keep_tangent() {
  constexpr std::ptrdiff_t most_bytes = 4 << 20;
  const std::ptrdiff_t n = kept_size(springs_.layout, springs_.volume_stiffness != nullptr);
  if (springs_.law == LawKind::hooke || n * std::ptrdiff_t{sizeof(Real)} > most_bytes) return false;
  if (!kept_) kept_ = add_array(n);
  return true;
}

/// Runs a kernel over the slabs and then adds every slab's spill to the plane it belongs to.
template<class Real>
template<class Run>
void SpringField<Real>::for_each_slab(int components, Real* result, const Run& run) const {
  const Layout& layout = springs_.layout;
  const auto n = static_cast<std::ptrdiff_t>(slabs_.size());
  const auto add_spill = [&](std::ptrdiff_t s) {
    for (int c = 0; c < components; ++c) {
      const Slab<Real>& slab = slabs_[index(s)];
      Real* plane = result + layout.at(0, 0, slab.last, c) - layout.at(0, 0, -1);
      const Real* spill = slab.spill + c * layout.plane;
      for (std::ptrdiff_t i = 0; i < layout.plane; ++i) plane[i] += spill[i];
    }
  };
  on_threads(n, [&](std::ptrdiff_t s) { run(slabs_[index(s)]); });
  on_threads(n - 1, add_spill);
}

template<class Real>
template<class Action>
void SpringField<Real>::on_threads(std::ptrdiff_t n, const Action& action) const {
  mechanics::grid::on_threads(n, springs_.layout.size <= mechanics::grid::worth_threads ? 1 : n_threads_,
                              action);
}

template<class Real>
void SpringField<Real>::force(const Field<Real>& displacement, Field<Real>& force) const {
  reactions(displacement, force);
  clear_held(force);
}

/// Entries of nodes without a cell are constrained too, but nothing writes to them.
template<class Real>
void SpringField<Real>::clear_held(Field<Real>& field) const {
  for (const std::ptrdiff_t entry : held_) field[entry] = 0;
}

template<class Real>
void SpringField<Real>::reactions(const Field<Real>& displacement, Field<Real>& force) const {
  for_each_slab(3, force.data(), [&](const Slab<Real>& slab) {
    kernels<Real>().force(springs_, slab, displacement.data(), force.data());
  });
  update_ghosts(body_, force);
}

template<class Real>
void SpringField<Real>::product(Clamp clamp, const Field<Real>& displacement, const Field<Real>& direction,
                                Field<Real>& product) const {
  for_each_slab(3, product.data(), [&](const Slab<Real>& slab) {
    kernels<Real>().product(springs_, slab, clamp, displacement.data(), direction.data(), product.data());
  });
  clear_held(product);
  update_ghosts(body_, product);
}

template<class Real>
void SpringField<Real>::kept_product(const Field<Real>& displacement, const Field<Real>& direction,
                                     Field<Real>& product) const {
  for_each_slab(3, product.data(), [&](const Slab<Real>& slab) {
    kernels<Real>().kept_product(springs_, slab, kept_, displacement.data(), direction.data(),
                                 product.data());
  });
  clear_held(product);
  update_ghosts(body_, product);
}

template<class Real>
void SpringField<Real>::inverse_diagonal(Clamp clamp, const Field<Real>& displacement, Field<Real>& inverse,
                                         const Field<Real>& added) const {
  const Layout& layout = springs_.layout;
  inverse.setZero(6 * layout.size);
  for_each_slab(6, inverse.data(), [&](const Slab<Real>& slab) {
    kernels<Real>().diagonal(springs_, slab, clamp, displacement.data(), inverse.data(), kept_);
  });
  static constexpr int places[3][3] = {{0, 5, 4}, {5, 1, 3}, {4, 3, 2}}; // numbers of the six arrays
  for_each_plane(layout, n_threads_, [&](int k) {
    for (int j = 0; j < layout.nodes[1]; ++j)
      for (int i = 0; i < layout.nodes[0]; ++i) {
        Eigen::Matrix3d block;
        for (int a = 0; a < 3; ++a)
          for (int b = 0; b < 3; ++b) block(a, b) = inverse[layout.at(i, j, k, places[a][b])];
        bool is_free[3];
        for (int a = 0; a < 3; ++a) {
          if (added.size() > 0) block(a, a) += static_cast<double>(added[layout.at(i, j, k, a)]);
          is_free[a] = !is_constrained_[index(layout.at(i, j, k, a))] && block(a, a) > 0;
        }
        const Eigen::Matrix3d inverted = mechanics::grid::inverse_on_free(block, is_free, 1e-9);
        for (int a = 0; a < 3; ++a)
          for (int b = a; b < 3; ++b)
            inverse[layout.at(i, j, k, places[a][b])] = static_cast<Real>(inverted(a, b));
      }
  });
  if (!body_.part) return;
  for (const int three : {0, 3}) body_.part->ranks->update_ghosts(inverse.data() + three * layout.size);
}

template<class Real>
double SpringField<Real>::energy(const Field<Real>& displacement) const {
  const auto n = static_cast<std::ptrdiff_t>(slabs_.size());
  const int first = body_.part ? body_.part->own_first[2] : 0;
  const int last = body_.part ? body_.part->own_last[2] : springs_.layout.nodes[2];
  on_threads(n, [&](std::ptrdiff_t s) {
    const Slab<Real>& slab = slabs_[index(s)];
    energy_of_slab_[index(s)] = kernels<Real>().energy(springs_, std::max(slab.first, first),
                                                       std::min(slab.last, last), displacement.data());
  });
  double sum = 0;
  for (double value : energy_of_slab_) sum += value;
  if (body_.part) body_.part->ranks->sum(&sum, 1);
  return sum;
}

/// Adds up cells, each as a lattice of its own.
template<class Real>
double SpringField<Real>::small_motion_energy(const Field<Real>& motion) const {
  Lattice alone;
  alone.volume_cells = {{{0, 1, 2, 3, 4, 5, 6, 7}, 0, body_.spacing.prod()}};
  for (int v = 0; v < 8; ++v)
    alone.rest.push_back(vertex_of_cell(v).cast<double>().cwiseProduct(body_.spacing));
  for (int v = 0; v < 8; ++v)
    for (int w = v + 1; w < 8; ++w)
      alone.links.push_back({v, w, {0, (alone.rest[index(w)] - alone.rest[index(v)]).norm()}});
  for (int axis = 0; axis < 3; ++axis)
    alone.midlines.push_back({alone.volume_cells.front().nodes, axis, {0, body_.spacing[axis]}});
  Points moved(8);
  double sum = 0;
  for_each_place(body_.cells, [&](int i, int j, int k) {
    if (body_.part && !body_.part->owns(i, j, k)) return;
    const CellSprings& cell = body_.cell(i, j, k);
    for (Link& link : alone.links) link.spring.stiffness = stiffness_across(cell, link.i ^ link.j);
    for (Midline& midline : alone.midlines) midline.spring.stiffness = cell.midline[index(midline.axis)];
    alone.volume_cells.front().stiffness = cell.volume;
    for (int v = 0; v < 8; ++v) {
      const Eigen::Vector3i at = Eigen::Vector3i(i, j, k) + vertex_of_cell(v);
      for (int a = 0; a < 3; ++a)
        moved[index(v)][a] = static_cast<double>(motion[body_.layout.at(at[0], at[1], at[2], a)]);
    }
    sum += msm::small_motion_energy(alone, moved);
  });
  if (body_.part) body_.part->ranks->sum(&sum, 1);
  return sum;
}

template class SpringField<double>;
template class SpringField<float>;

} // namespace springproof::msm::grid
