#include "cases/scene/scene.hpp"

#include "cases/mesh/mesh.hpp"
#include "cases/scene/regions.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace springproof::cases {

using Eigen::Vector3d;

namespace {

/// The cells of a grid whose centre lies in a removed piece's box: from first to before end along each axis.
struct Block {
  std::array<int, 3> first, end;
  bool has(const std::array<int, 3>& cell) const {
    for (std::size_t a = 0; a < 3; ++a)
      if (cell[a] < first[a] || cell[a] >= end[a]) return false;
    return true;
  }
};

Block block_of(const Grid& grid, const Removed& removed) {
  Block block;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto axis = static_cast<int>(a);
    const double n = grid.cells[a];
    const auto place = [&](double at) { return (at - grid.origin[axis]) / grid.spacing[axis] - 0.5; };
    block.first[a] = static_cast<int>(std::clamp(std::ceil(place(removed.lower[axis])), 0., n));
    block.end[a] = static_cast<int>(std::clamp(std::floor(place(removed.upper[axis])) + 1, 0., n));
  }
  return block;
}

template<class Action>
void for_each_cell(const Grid& grid, const Action& action) {
  std::size_t number = 0; // counts all places, with or without a cell
  for (int k = 0; k < grid.cells[2]; ++k)
    for (int j = 0; j < grid.cells[1]; ++j)
      for (int i = 0; i < grid.cells[0]; ++i) action(std::array<int, 3>{i, j, k}, number++);
}

/// One side of a removed piece across the axis of its joint.
struct CutSide {
  std::vector<int> free;   ///< nodes that are to be joined
  std::vector<int> held;   ///< nodes whose displacement along the axis is prescribed
  double displacement = 0; ///< the held nodes' at full load, mm
};

/// The displacement that supports prescribe for a node at full load; nothing where it is free.
std::optional<double> prescribed(const Scene& scene, int node, std::size_t axis) {
  const auto has = [&](const Selection& selection) {
    return std::binary_search(selection.nodes.begin(), selection.nodes.end(), node);
  };
  for (const auto& [selection, motion] : scene.moved)
    if (motion.components[axis] && has(selection))
      return moved_by(motion, scene.mesh.nodes[index(node)], 1)[static_cast<int>(axis)];
  for (const auto& [selection, components] : scene.constrained)
    if (components[axis] && has(selection)) return 0;
  return std::nullopt;
}

/// @param plane  number of the side's nodes along the axis
CutSide side_of(const Scene& scene, const Removed& removed, const Block& block, int plane, const char* name) {
  const Grid& grid = *scene.mesh.grid;
  const auto axis = static_cast<std::size_t>(*removed.join);
  const int layer =
      plane == block.first[axis] ? block.first[axis] : block.end[axis] - 1; // the gap's layer of cells
  CutSide side;
  for (std::size_t n = 0; n < scene.mesh.nodes.size(); ++n) {
    const Vector3d place = (scene.mesh.nodes[n] - grid.origin).cwiseQuotient(grid.spacing);
    std::array<int, 3> at;
    bool is_here = true;
    for (std::size_t a = 0; a < 3; ++a) {
      at[a] = static_cast<int>(std::lround(place[static_cast<int>(a)]));
      is_here = is_here && (a == axis ? at[a] == plane : at[a] >= block.first[a] && at[a] <= block.end[a]);
    }
    if (!is_here) continue;
    bool has_cell_in_gap = false;
    const std::size_t b = (axis + 1) % 3, c = (axis + 2) % 3;
    for (int s = 0; s < 4; ++s) {
      std::array<int, 3> cell = at;
      cell[axis] = layer;
      cell[b] -= s & 1;
      cell[c] -= s >> 1;
      has_cell_in_gap = has_cell_in_gap || grid.has(cell[0], cell[1], cell[2]);
    }
    const int node = static_cast<int>(n);
    if (const auto value = prescribed(scene, node, axis)) {
      if (!side.held.empty() && !(std::abs(*value - side.displacement) <= 1e-9 * grid.spacing.norm()))
        refuse(removed.where,
               "its {} side is not moved as a whole along {}, and is to be joined: must be held or shifted "
               "by one displacement",
               name, name_of(*removed.join));
      side.displacement = *value;
      side.held.push_back(node);
    } else if (!has_cell_in_gap) {
      side.free.push_back(node);
    }
  }
  if (side.held.empty())
    refuse(removed.where,
           "no node of its {} side is fixed or moved along {}, which says where the sides are to be joined",
           name, name_of(*removed.join));
  return side;
}

} // namespace

Mesh cut(Mesh mesh, const std::vector<Removed>& removed) {
  if (removed.empty()) return mesh;
  if (!mesh.grid || !mesh.groups.empty())
    throw InputError(
        removed.front().where,
        "must be left out: pieces are removed from bodies that are grids of cells without groups");
  Grid grid = *mesh.grid;
  if (grid.present.empty()) grid.present.assign(grid.n_lattice_cells(), true);
  const std::vector<bool> before = grid.present;
  for (std::size_t r = 0; r < removed.size(); ++r) {
    const Block block = block_of(grid, removed[r]);
    std::size_t n_cells = 0;
    for_each_cell(grid, [&](const std::array<int, 3>& cell, std::size_t number) {
      if (!before[number] || !block.has(cell)) return;
      if (!grid.present[number])
        throw InputError(removed[r].where, "overlaps another piece: a cell is removed once");
      grid.present[number] = false;
      ++n_cells;
    });
    if (n_cells == 0) throw InputError(removed[r].where, "no cell has its centre in the box");
  }
  if (const int n = static_cast<int>(pieces_of(grid).sizes.size()); n != 1)
    throw InputError(removed.back().where,
                     n == 0 ? std::string("nothing is left of the body")
                            : fmt::format("the body falls into {} pieces that share no face", n));
  std::vector<std::string> group_of_cell;
  std::size_t cell = 0;
  for (std::size_t number = 0; number < before.size() && !mesh.group_of_cell.empty(); ++number) {
    if (grid.present[number]) group_of_cell.push_back(mesh.group_of_cell[cell]);
    if (before[number]) ++cell;
  }
  Mesh left = make_grid_mesh(grid);
  left.group_of_cell = std::move(group_of_cell);
  return left;
}

std::optional<Removed> first_joined(const Case& definition) {
  for (const Removed& removed : definition.removed)
    if (removed.join) return removed;
  return std::nullopt;
}

void join_cuts(Scene& scene) {
  for (const Removed& removed : scene.definition.removed) {
    if (!removed.join) continue;
    const auto axis = static_cast<std::size_t>(*removed.join);
    const Block block = block_of(*scene.mesh.grid, removed);
    if (block.first[axis] == 0 || block.end[axis] == scene.mesh.grid->cells[axis])
      refuse(removed.where, "has nothing on one side along {}, and is to be joined", name_of(*removed.join));
    const CutSide lower = side_of(scene, removed, block, block.first[axis], "lower"),
                  upper = side_of(scene, removed, block, block.end[axis], "upper");
    const double gap =
                     (block.end[axis] - block.first[axis]) * scene.mesh.grid->spacing[static_cast<int>(axis)],
                 left_open = gap + upper.displacement - lower.displacement;
    if (!(std::abs(left_open) <= 1e-6 * gap))
      refuse(removed.where,
             "its sides end {:.6g} mm apart along {}, and are to be joined: what holds and moves them must "
             "bring them together",
             left_open, name_of(*removed.join));
    if (lower.free.empty() && upper.free.empty())
      throw InputError(removed.where,
                       "has no free node to join: cells are left between all nodes of its sides");
    for (const CutSide* side : {&lower, &upper}) {
      if (side->free.empty()) continue;
      Moved motion;
      motion.region.where = removed.where;
      motion.components = {axis == 0, axis == 1, axis == 2};
      motion.displacement[static_cast<int>(axis)] = side->displacement;
      std::vector<bool> is_free(scene.mesh.nodes.size(), false);
      for (const int node : side->free) is_free[index(node)] = true;
      scene.moved.push_back({select_between(scene.mesh, is_free), motion});
      scene.constrained.push_back({scene.moved.back().selection, motion.components});
    }
  }
}

void check_scaled(const Scene& scene) {
  for (const auto& [selection, motion] : scene.moved) {
    if (!motion.scaled) continue;
    bool is_scaled = false, is_whole = false;
    for (const int node : selection.nodes) {
      const double factor = motion.scaled->factor(scene.mesh.nodes[index(node)]);
      is_scaled = is_scaled || (factor > 0 && factor < 1);
      is_whole = is_whole || factor == 1;
    }
    if (!is_scaled)
      throw InputError(motion.scaled->where, "no node of the region lies within the zone that is scaled, "
                                             "which must be longer than a cell and cross the region");
    if (!is_whole)
      throw InputError(
          motion.scaled->where,
          "no node of the region lies beyond the zone that is scaled: nothing would make the whole motion");
  }
}

} // namespace springproof::cases
