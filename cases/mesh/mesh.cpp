#include "cases/mesh/mesh.hpp"

#include "cases/mesh/sharing.hpp"

#include <cassert>
#include <cmath>

namespace springproof::cases {

using Eigen::Vector3d;

// Two of them have two vertices exchanged, so that all have a positive volume; the edge that divides their
// own middles, from the midpoint of 0 and 2 to that of 1 and 3, stays.
const std::array<std::array<std::array<int, 2>, 4>, 8> tetrahedron_children{
    {{{{0, 0}, {0, 1}, {0, 2}, {0, 3}}},
     {{{0, 1}, {1, 1}, {1, 2}, {1, 3}}},
     {{{0, 2}, {1, 2}, {2, 2}, {2, 3}}},
     {{{0, 3}, {1, 3}, {2, 3}, {3, 3}}},
     {{{0, 1}, {0, 2}, {0, 3}, {1, 3}}},
     {{{1, 2}, {0, 2}, {0, 1}, {1, 3}}},
     {{{0, 2}, {0, 3}, {1, 3}, {2, 3}}},
     {{{1, 3}, {1, 2}, {0, 2}, {2, 3}}}}};

namespace {

/// Calls action(i, j, k) for every place of a grid, x fastest.
template<class Action>
void for_each_place(const std::array<int, 3>& counts, const Action& action) {
  for (int k = 0; k < counts[2]; ++k)
    for (int j = 0; j < counts[1]; ++j)
      for (int i = 0; i < counts[0]; ++i) action(i, j, k);
}

std::size_t number_of(int i, int j, int k, const std::array<int, 3>& counts) {
  return index(i) + index(counts[0]) * (index(j) + index(counts[1]) * index(k));
}

/// A position in steps of a spacing, if these are whole numbers in each direction, to 1e-8 of the spacing.
std::optional<std::array<int, 3>> steps(const Vector3d& from_origin, const Vector3d& spacing) {
  std::array<int, 3> whole{};
  for (int a = 0; a < 3; ++a) {
    const double ratio = from_origin[a] / spacing[a];
    const double nearest = std::round(ratio);
    if (!(std::abs(ratio - nearest) <= 1e-8 * std::max(1.0, nearest)) || !(nearest < 1e6))
      return std::nullopt;
    whole[index(a)] = static_cast<int>(nearest);
  }
  return whole;
}

/// The cell with its vertices in the order i + 2j + 4k along the axes, if it is a cuboid with that spacing.
std::optional<CellNodes> along_axes(const Mesh& mesh, std::size_t cell, const Vector3d& spacing) {
  const CellCorners vertices = cell_corners(mesh, cell);
  const Vector3d lower = bounding_box(vertices).min();
  CellNodes ordered(8, -1);
  for (std::size_t v = 0; v < 8; ++v) {
    const auto corner = steps(vertices[v] - lower, spacing);
    if (!corner || sorted(*corner).back() > 1) return std::nullopt;
    ordered[number_of((*corner)[0], (*corner)[1], (*corner)[2], {2, 2, 2})] = mesh.cells[cell][v];
  }
  if (sorted(ordered).front() < 0) return std::nullopt;
  return ordered;
}

/// A lattice that has more places for each cell of the mesh is no grid worth having: a chain of n cells along
/// a diagonal would have n².
constexpr std::size_t most_places_of_a_cell = 64;

/// Numbers the midpoints of edges, faces and cells, each made once.
class Midpoints {
 public:
  explicit Midpoints(std::vector<Vector3d>& nodes) : nodes_(nodes) {}

  /// @param vertices  1 (its own midpoint), 2, 4 or 8
  int of(const std::vector<int>& vertices) {
    if (vertices.size() == 1) return vertices[0];
    std::array<int, 8> key;
    key.fill(-1);
    std::copy(vertices.begin(), vertices.end(), key.begin());
    const auto [found, is_new] = numbers_.try_emplace(sorted(key), static_cast<int>(nodes_.size()));
    if (is_new) {
      Vector3d sum = Vector3d::Zero();
      for (int v : vertices) sum += nodes_[index(v)];
      nodes_.push_back(sum / static_cast<double>(vertices.size()));
    }
    return found->second;
  }

 private:
  std::vector<Vector3d>& nodes_;
  std::map<std::array<int, 8>, int> numbers_;
};

/// The parts of a face: a corner's of a quadrangle is one, and a triangle has one in the middle too.
std::vector<FaceNodes> parts_of_face(const FaceNodes& face, Midpoints& midpoints) {
  const std::size_t n = face.size();
  FaceNodes middles; // one per side
  for (const auto& [from, to] : sides_of(face)) middles.push_back(midpoints.of({from, to}));
  std::vector<FaceNodes> parts;
  for (std::size_t v = 0; v < n; ++v) {
    parts.push_back({face[v], middles[v]});
    if (n == 4) parts.back().push_back(midpoints.of({face.begin(), face.end()}));
    parts.back().push_back(middles[(v + n - 1) % n]);
  }
  if (n == 3) parts.push_back(middles);
  return parts;
}

Selection refine_selection(const Selection& coarse, Midpoints& midpoints) {
  Selection fine;
  fine.nodes = coarse.nodes;
  for (const auto& edge : coarse.edges) {
    const int middle = midpoints.of({edge[0], edge[1]});
    fine.nodes.push_back(middle);
    for (int end : edge) fine.edges.push_back(sorted(std::array<int, 2>{end, middle}));
  }
  for (const FaceNodes& face : coarse.faces)
    for (const FaceNodes& part : parts_of_face(face, midpoints)) {
      fine.faces.push_back(part);
      fine.nodes.insert(fine.nodes.end(), part.begin(), part.end());
      for (const auto& side : sides_of(part)) fine.edges.push_back(sorted(side));
    }
  make_set(fine.edges);
  return fine;
}

/// The vertices of a child of a cell.
CellNodes child_of(const Mesh& mesh, std::size_t cell, int child, Midpoints& midpoints) {
  const CellNodes coarse = mesh.cells[cell];
  CellNodes fine;
  if (mesh.shape == CellShape::tetrahedron)
    for (const auto& [a, b] : tetrahedron_children[index(child)])
      fine.push_back(a == b ? coarse[index(a)] : midpoints.of({coarse[index(a)], coarse[index(b)]}));
  else
    for (int v = 0; v < 8; ++v) {
      std::vector<int> around; // vertices of the coarse cell on the child's side wherever v is on it too
      for (int w = 0; w < 8; ++w)
        if (((w ^ child) & ~(v ^ child)) == 0) around.push_back(coarse[index(w)]);
      fine.push_back(midpoints.of(around));
    }
  return fine;
}

} // namespace

std::size_t Grid::n_lattice_cells() const {
  return index(cells[0]) * index(cells[1]) * index(cells[2]);
}

double Grid::slenderness() const {
  Vector3d size = spacing.cwiseProduct(Vector3d(cells[0], cells[1], cells[2]));
  std::sort(size.begin(), size.end());
  return size[2] / size[1];
}

bool Grid::has(int i, int j, int k) const {
  if (i < 0 || j < 0 || k < 0 || i >= cells[0] || j >= cells[1] || k >= cells[2]) return false;
  return present.empty() || present[number_of(i, j, k, cells)];
}

Grid cropped(const Grid& grid) {
  std::array<int, 3> first = grid.cells, end{0, 0, 0};
  for_each_place(grid.cells, [&](int i, int j, int k) {
    if (!grid.has(i, j, k)) return;
    const std::array<int, 3> at{i, j, k};
    for (std::size_t a = 0; a < 3; ++a) {
      first[a] = std::min(first[a], at[a]);
      end[a] = std::max(end[a], at[a] + 1);
    }
  });
  if (end[0] == 0) return grid;
  Grid part;
  part.spacing = grid.spacing;
  part.origin = grid.origin + grid.spacing.cwiseProduct(Vector3d(first[0], first[1], first[2]));
  for (std::size_t a = 0; a < 3; ++a) part.cells[a] = end[a] - first[a];
  if (grid.present.empty()) return part;
  for_each_place(part.cells, [&](int i, int j, int k) {
    part.present.push_back(grid.has(first[0] + i, first[1] + j, first[2] + k));
  });
  return part;
}

Pieces pieces_of(const Grid& grid) {
  Pieces pieces;
  pieces.piece_of_cell.assign(grid.present.size(), -1);
  std::vector<std::size_t> to_visit;
  const auto visit = [&](std::size_t cell) {
    if (!grid.present[cell] || pieces.piece_of_cell[cell] >= 0) return;
    pieces.piece_of_cell[cell] = static_cast<int>(pieces.sizes.size()) - 1;
    to_visit.push_back(cell);
  };
  for (std::size_t first = 0; first < grid.present.size(); ++first) {
    if (!grid.present[first] || pieces.piece_of_cell[first] >= 0) continue;
    pieces.sizes.push_back(0);
    for (visit(first); !to_visit.empty(); ++pieces.sizes.back()) {
      const std::size_t cell = to_visit.back();
      to_visit.pop_back();
      std::size_t stride = 1;
      for (const int n_cells : grid.cells) {
        const std::size_t n = index(n_cells), place = cell / stride % n;
        if (place > 0) visit(cell - stride);
        if (place + 1 < n) visit(cell + stride);
        stride *= n;
      }
    }
  }
  return pieces;
}

Mesh make_grid_mesh(const Grid& grid) {
  assert(grid.present.empty() || grid.present.size() == grid.n_lattice_cells());
  Mesh mesh;
  mesh.grid = grid;
  if (grid.present.empty()) {
    const Vector3d size = grid.spacing.cwiseProduct(Vector3d(grid.cells[0], grid.cells[1], grid.cells[2]));
    mesh.nodes = RuledList(GridNodes{grid.cells, grid.origin, grid.spacing, grid.origin + size});
    mesh.cells = RuledList(GridCells{grid.cells});
    return mesh;
  }
  const std::array<int, 3> points{grid.cells[0] + 1, grid.cells[1] + 1, grid.cells[2] + 1};
  std::vector<int> numbers(index(points[0]) * index(points[1]) * index(points[2]), -1);
  /// Calls action(place of a vertex in the cell, its number) for the vertices of every present cell.
  const auto for_each_vertex = [&](const auto& action) {
    for_each_place(grid.cells, [&](int i, int j, int k) {
      for (int v = 0; grid.has(i, j, k) && v < 8; ++v)
        action(v, numbers[number_of(i + (v & 1), j + ((v >> 1) & 1), k + (v >> 2), points)]);
    });
  };
  for_each_vertex([](int, int& number) { number = 0; });
  std::vector<Vector3d> nodes;
  std::vector<CellNodes> cells;
  for_each_place(points, [&](int i, int j, int k) {
    int& number = numbers[number_of(i, j, k, points)];
    if (number < 0) return;
    number = static_cast<int>(nodes.size());
    nodes.emplace_back(grid.origin + Vector3d(i, j, k).cwiseProduct(grid.spacing));
  });
  for_each_vertex([&](int v, int number) {
    if (v == 0) cells.emplace_back();
    cells.back().push_back(number);
  });
  mesh.nodes = std::move(nodes);
  mesh.cells = std::move(cells);
  return mesh;
}

Mesh make_box_mesh(const Vector3d& size, const std::array<int, 3>& cells) {
  Grid grid;
  grid.cells = cells;
  grid.spacing = size.cwiseQuotient(Vector3d(cells[0], cells[1], cells[2]));
  Mesh mesh = make_grid_mesh(grid);
  // n * (size / n) need not be size: the far faces are put where the case file says.
  mesh.nodes = RuledList(GridNodes{grid.cells, grid.origin, grid.spacing, size});
  return mesh;
}

bool find_grid(Mesh& mesh) {
  if (mesh.shape != CellShape::hexahedron) return false;
  const Eigen::AlignedBox3d body = bounding_box(mesh.nodes);
  Grid grid;
  grid.origin = body.min();
  grid.spacing = bounding_box(cell_corners(mesh, 0)).sizes();
  if (!((grid.spacing.array() > 0).all())) return false;
  const auto extent = steps(body.sizes(), grid.spacing);
  if (!extent) return false;
  grid.cells = *extent;
  if (grid.n_lattice_cells() / most_places_of_a_cell > mesh.cells.size()) return false;

  const std::array<int, 3> points{grid.cells[0] + 1, grid.cells[1] + 1, grid.cells[2] + 1};
  std::map<std::size_t, int> node_at; // two nodes at a place are a slit, which no grid has
  std::map<std::size_t, std::pair<CellNodes, std::size_t>> by_place;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    const auto cell = along_axes(mesh, c, grid.spacing);
    if (!cell) return false;
    const auto place = steps(mesh.nodes[index((*cell)[0])] - grid.origin, grid.spacing);
    if (!place) return false;
    const std::size_t number = number_of((*place)[0], (*place)[1], (*place)[2], grid.cells);
    if (!by_place.emplace(number, std::pair(*cell, c)).second) return false;
    for (int v = 0; v < 8; ++v) {
      const std::size_t point =
          number_of((*place)[0] + (v & 1), (*place)[1] + ((v >> 1) & 1), (*place)[2] + (v >> 2), points);
      const int node = (*cell)[index(v)];
      if (node_at.emplace(point, node).first->second != node) return false;
    }
  }
  // The first cell's spacing carries its rounding; that from the whole body carries less.
  grid.spacing = body.sizes().cwiseQuotient(Vector3d(grid.cells[0], grid.cells[1], grid.cells[2]));

  if (mesh.cells.size() < grid.n_lattice_cells()) grid.present.assign(grid.n_lattice_cells(), false);
  const std::vector<std::string> groups = mesh.group_of_cell;
  std::vector<CellNodes>& cells = mesh.cells.stored();
  std::size_t c = 0;
  for (const auto& [number, cell] : by_place) {
    if (!grid.present.empty()) grid.present[number] = true;
    cells[c] = cell.first;
    if (!groups.empty()) mesh.group_of_cell[c] = groups[cell.second];
    ++c;
  }
  mesh.grid = grid;
  return true;
}

Mesh refine(const Mesh& mesh) {
  Mesh fine;
  std::vector<Vector3d>& nodes = fine.nodes.stored();
  std::vector<CellNodes>& cells = fine.cells.stored();
  fine.shape = mesh.shape;
  nodes = mesh.nodes.to_vector();
  Midpoints midpoints(nodes);
  cells.reserve(8 * mesh.cells.size());
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    for (int child = 0; child < 8; ++child) {
      cells.push_back(child_of(mesh, c, child, midpoints));
      if (!mesh.group_of_cell.empty()) fine.group_of_cell.push_back(mesh.group_of_cell[c]);
    }
  for (const auto& [name, group] : mesh.groups) fine.groups[name] = refine_selection(group, midpoints);
  // A three-dimensional group has no faces of its own: its nodes are those of its cells.
  for (std::size_t c = 0; c < fine.group_of_cell.size(); ++c) {
    Selection& group = fine.groups[fine.group_of_cell[c]];
    group.nodes.insert(group.nodes.end(), cells[c].begin(), cells[c].end());
  }
  for (auto& entry : fine.groups) make_set(entry.second.nodes);
  return fine;
}

std::vector<bool> inverted_cells(const Mesh& mesh, const std::vector<Vector3d>& displacement,
                                 const Sharing* sharing) {
  const Share here = share_here(mesh, sharing);
  std::vector<bool> inverted;
  for (std::size_t c = here.cells.begin; c < here.cells.end; ++c)
    inverted.push_back(
        !(smallest_corner_jacobian(cell_corners(mesh, c, displacement, here.nodes.begin)) > 0));
  return inverted;
}

int n_inverted(const Mesh& mesh, const std::vector<Vector3d>& displacement, const Sharing* sharing) {
  const std::vector<bool> inverted = inverted_cells(mesh, displacement, sharing);
  const auto n = std::count(inverted.begin(), inverted.end(), true);
  return static_cast<int>(sharing ? sharing->sum(static_cast<double>(n)) : static_cast<double>(n));
}

CellCorners cell_corners(const Mesh& mesh, std::size_t cell, const std::vector<Vector3d>& displacement,
                         std::size_t first_node) {
  CellCorners corners;
  for (const int number : mesh.cells[cell]) {
    corners.push_back(mesh.nodes[index(number)]);
    if (!displacement.empty()) corners.back() += displacement[index(number) - first_node];
  }
  return corners;
}

std::array<Vector3d, 8> cell_vertices(const Mesh& mesh, std::size_t cell,
                                      const std::vector<Vector3d>& displacement, std::size_t first_node) {
  assert(mesh.shape == CellShape::hexahedron);
  const CellCorners corners = cell_corners(mesh, cell, displacement, first_node);
  std::array<Vector3d, 8> vertices;
  std::copy(corners.begin(), corners.end(), vertices.begin());
  return vertices;
}

namespace {

/// The faces of a grid, without memory for others.
std::vector<FaceNodes> boundary_faces_of_grid(const Mesh& mesh) {
  const ReferenceCell& shape = reference_cell(mesh.shape);
  std::vector<FaceNodes> faces;
  std::size_t cell = 0;
  for_each_place(mesh.grid->cells, [&](int i, int j, int k) {
    if (!mesh.grid->has(i, j, k)) return;
    for (std::size_t f = 0; f < shape.faces.size(); ++f) {
      std::array<int, 3> neighbour{i, j, k};
      neighbour[f / 2] += f % 2 == 0 ? -1 : 1;
      if (!mesh.grid->has(neighbour[0], neighbour[1], neighbour[2]))
        faces.push_back(pick(mesh.cells[cell], shape.faces[f]));
    }
    ++cell;
  });
  return faces;
}

} // namespace

std::vector<FaceNodes> boundary_faces(const Mesh& mesh) {
  if (mesh.grid) return boundary_faces_of_grid(mesh);
  std::map<FaceNodes, int> uses;
  const auto for_each_face = [&](const auto& action) {
    for (const CellNodes& cell : mesh.cells)
      for (const FaceNodes& local : reference_cell(mesh.shape).faces) action(pick(cell, local));
  };
  for_each_face([&](const FaceNodes& face) { ++uses[sorted(face)]; });
  std::vector<FaceNodes> faces;
  for_each_face([&](const FaceNodes& face) {
    if (uses[sorted(face)] == 1) faces.push_back(face);
  });
  return faces;
}

} // namespace springproof::cases
