#include "cases/mesh/hex_mesh.hpp"

#include "cases/case/index.hpp"
#include "mechanics/hexahedron.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace springproof::cases {

using Eigen::Vector3d;

const std::array<std::array<int, 2>, 12> cell_edges{
    {{0, 1}, {2, 3}, {4, 5}, {6, 7}, {0, 2}, {1, 3}, {4, 6}, {5, 7}, {0, 4}, {1, 5}, {2, 6}, {3, 7}}};

const std::array<std::array<int, 2>, 12> cell_face_diagonals{
    {{0, 6}, {2, 4}, {1, 7}, {3, 5}, {0, 5}, {1, 4}, {2, 7}, {3, 6}, {0, 3}, {1, 2}, {4, 7}, {5, 6}}};

const std::array<std::array<int, 2>, 4> cell_internal_diagonals{{{0, 7}, {1, 6}, {2, 5}, {3, 4}}};

const std::array<std::array<int, 4>, 6> cell_faces{
    {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};

namespace {

template<std::size_t N>
std::array<int, N> sorted(std::array<int, N> values) {
  std::sort(values.begin(), values.end());
  return values;
}

template<std::size_t N>
std::array<int, N> pick(const std::array<int, 8>& cell, const std::array<int, N>& local) {
  std::array<int, N> nodes{};
  for (std::size_t v = 0; v < N; ++v) nodes[v] = cell[static_cast<std::size_t>(local[v])];
  return nodes;
}

} // namespace

std::size_t Grid::n_lattice_cells() const {
  return index(cells[0]) * index(cells[1]) * index(cells[2]);
}

bool Grid::has(int i, int j, int k) const {
  if (i < 0 || j < 0 || k < 0 || i >= cells[0] || j >= cells[1] || k >= cells[2]) return false;
  return present.empty() || present[index(i) + index(cells[0]) * (index(j) + index(cells[1]) * index(k))];
}

HexMesh make_grid_mesh(const Grid& grid) {
  assert(grid.present.empty() || grid.present.size() == grid.n_lattice_cells());
  const std::array<int, 3> points{grid.cells[0] + 1, grid.cells[1] + 1, grid.cells[2] + 1};
  const auto point = [&](int i, int j, int k) {
    return index(i) + index(points[0]) * (index(j) + index(points[1]) * index(k));
  };
  const auto for_each_present = [&](const auto& action) {
    for (int k = 0; k < grid.cells[2]; ++k)
      for (int j = 0; j < grid.cells[1]; ++j)
        for (int i = 0; i < grid.cells[0]; ++i)
          if (grid.has(i, j, k)) action(i, j, k);
  };
  std::vector<int> number(index(points[0]) * index(points[1]) * index(points[2]), -1);
  for_each_present([&](int i, int j, int k) {
    for (int v = 0; v < 8; ++v) number[point(i + (v & 1), j + ((v >> 1) & 1), k + (v >> 2))] = 0;
  });
  HexMesh mesh;
  for (int k = 0; k < points[2]; ++k)
    for (int j = 0; j < points[1]; ++j)
      for (int i = 0; i < points[0]; ++i) {
        int& n = number[point(i, j, k)];
        if (n < 0) continue;
        n = static_cast<int>(mesh.nodes.size());
        mesh.nodes.emplace_back(grid.origin + Vector3d(i, j, k).cwiseProduct(grid.spacing));
      }
  for_each_present([&](int i, int j, int k) {
    std::array<int, 8> cell{};
    for (int v = 0; v < 8; ++v) cell[index(v)] = number[point(i + (v & 1), j + ((v >> 1) & 1), k + (v >> 2))];
    mesh.cells.push_back(cell);
  });
  mesh.grid = grid;
  return mesh;
}

HexMesh make_box_mesh(const Vector3d& size, const std::array<int, 3>& cells) {
  Grid grid;
  grid.cells = cells;
  grid.spacing = size.cwiseQuotient(Vector3d(cells[0], cells[1], cells[2]));
  HexMesh mesh = make_grid_mesh(grid);
  // n * (size / n) need not be size: the far faces are put where the case file says.
  for (Vector3d& node : mesh.nodes)
    for (int a = 0; a < 3; ++a)
      if (std::abs(node[a] - size[a]) < 1e-9 * size[a]) node[a] = size[a];
  return mesh;
}

namespace {

/// Numbers the midpoints of edges, faces and cells, each made once.
class Midpoints {
 public:
  explicit Midpoints(std::vector<Vector3d>& nodes) : nodes_(nodes) {}

  template<std::size_t N>
  int of(const std::array<int, N>& vertices) {
    if constexpr (N == 1) return vertices[0];
    std::array<int, 8> key;
    key.fill(-1);
    std::copy(vertices.begin(), vertices.end(), key.begin());
    std::sort(key.begin(), key.begin() + N);
    const auto [found, is_new] = numbers_.try_emplace(key, static_cast<int>(nodes_.size()));
    if (is_new) {
      Vector3d sum = Vector3d::Zero();
      for (int v : vertices) sum += nodes_[index(v)];
      nodes_.push_back(sum / static_cast<double>(N));
    }
    return found->second;
  }

 private:
  std::vector<Vector3d>& nodes_;
  std::map<std::array<int, 8>, int> numbers_;
};

/// Node at lattice position (a, b, c) in {0, 1, 2}³ of a cell: a vertex, or the midpoint of an edge, a face
/// or the cell.
int cell_lattice_node(const std::array<int, 8>& cell, int a, int b, int c, Midpoints& midpoints) {
  std::vector<int> vertices;
  for (int v = 0; v < 8; ++v) {
    const auto matches = [](int position, int bit) { return position == 1 || position == 2 * bit; };
    if (matches(a, v & 1) && matches(b, (v >> 1) & 1) && matches(c, v >> 2))
      vertices.push_back(cell[index(v)]);
  }
  switch (vertices.size()) {
  case 1:
    return vertices[0];
  case 2:
    return midpoints.of<2>({vertices[0], vertices[1]});
  case 4:
    return midpoints.of<4>({vertices[0], vertices[1], vertices[2], vertices[3]});
  default:
    return midpoints.of<8>(cell);
  }
}

Selection refine_selection(const Selection& coarse, Midpoints& midpoints) {
  Selection fine;
  fine.nodes = coarse.nodes;
  for (const auto& edge : coarse.edges) {
    const int middle = midpoints.of(edge);
    fine.nodes.push_back(middle);
    for (int end : edge) fine.edges.push_back(sorted<2>({end, middle}));
  }
  for (const auto& face : coarse.faces) {
    const int middle = midpoints.of(face);
    fine.nodes.push_back(middle);
    for (std::size_t v = 0; v < 4; ++v) {
      const int next = midpoints.of<2>({face[v], face[(v + 1) % 4]});
      const int previous = midpoints.of<2>({face[v], face[(v + 3) % 4]});
      fine.faces.push_back({face[v], next, middle, previous});
      fine.edges.push_back(sorted<2>({next, middle}));
      fine.nodes.push_back(next);
    }
  }
  std::sort(fine.nodes.begin(), fine.nodes.end());
  fine.nodes.erase(std::unique(fine.nodes.begin(), fine.nodes.end()), fine.nodes.end());
  return fine;
}

} // namespace

HexMesh refine(const HexMesh& mesh) {
  HexMesh fine;
  fine.nodes = mesh.nodes;
  Midpoints midpoints(fine.nodes);
  fine.cells.reserve(8 * mesh.cells.size());
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    for (int child = 0; child < 8; ++child) {
      std::array<int, 8> cell{};
      for (int v = 0; v < 8; ++v)
        cell[index(v)] =
            cell_lattice_node(mesh.cells[c], (child & 1) + (v & 1), ((child >> 1) & 1) + ((v >> 1) & 1),
                              (child >> 2) + (v >> 2), midpoints);
      fine.cells.push_back(cell);
      if (!mesh.group_of_cell.empty()) fine.group_of_cell.push_back(mesh.group_of_cell[c]);
    }
  for (const auto& [name, group] : mesh.groups) fine.groups[name] = refine_selection(group, midpoints);
  // A three-dimensional group has no faces of its own: its nodes are those of its cells.
  for (std::size_t c = 0; c < fine.group_of_cell.size(); ++c) {
    Selection& group = fine.groups[fine.group_of_cell[c]];
    group.nodes.insert(group.nodes.end(), fine.cells[c].begin(), fine.cells[c].end());
  }
  for (auto& entry : fine.groups) {
    std::vector<int>& nodes = entry.second.nodes;
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  }
  return fine;
}

double cell_volume(const std::array<Vector3d, 8>& vertices) {
  double volume = 0;
  for (int q = 0; q < 8; ++q)
    volume += mechanics::jacobian(vertices, mechanics::gauss_point(q)).determinant() / 8;
  return volume;
}

double smallest_corner_jacobian(const std::array<Vector3d, 8>& vertices) {
  double smallest = std::numeric_limits<double>::infinity();
  for (int v = 0; v < 8; ++v) {
    const Vector3d& here = vertices[index(v)];
    const Vector3d x = vertices[index(v ^ 1)] - here, y = vertices[index(v ^ 2)] - here,
                   z = vertices[index(v ^ 4)] - here;
    const bool mirrored = (v ^ (v >> 1) ^ (v >> 2)) & 1; // an odd number of the edges leads backwards
    const double determinant = x.dot(y.cross(z));
    smallest = std::min(smallest, mirrored ? -determinant : determinant);
  }
  return smallest;
}

std::array<Vector3d, 8> cell_vertices(const HexMesh& mesh, std::size_t cell,
                                      const std::vector<Vector3d>& displacement) {
  std::array<Vector3d, 8> vertices;
  for (std::size_t v = 0; v < 8; ++v) {
    const std::size_t node = index(mesh.cells[cell][v]);
    vertices[v] = displacement.empty() ? mesh.nodes[node] : Vector3d(mesh.nodes[node] + displacement[node]);
  }
  return vertices;
}

std::vector<std::array<int, 4>> boundary_faces(const HexMesh& mesh) {
  std::map<std::array<int, 4>, int> uses;
  const auto for_each_face = [&](const auto& action) {
    for (const auto& cell : mesh.cells)
      for (const auto& local : cell_faces) action(pick(cell, local));
  };
  for_each_face([&](const std::array<int, 4>& face) { ++uses[sorted(face)]; });
  std::vector<std::array<int, 4>> faces;
  for_each_face([&](const std::array<int, 4>& face) {
    if (uses[sorted(face)] == 1) faces.push_back(face);
  });
  return faces;
}

} // namespace springproof::cases
