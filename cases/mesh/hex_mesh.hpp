#pragma once

#include "cases/mesh/grid_lists.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace springproof::cases {

/// Converts the number of a node, a cell, ..., which is not negative, to the containers' index type.
inline std::size_t index(std::ptrdiff_t i) {
  return static_cast<std::size_t>(i);
}

/// What a region of a mesh selects. Faces and edges are given by their vertices, so that an element with
/// nodes on them (a quadratic one) can constrain those too. Nodes are sorted and unique.
struct Selection {
  std::vector<int> nodes;
  std::vector<std::array<int, 2>> edges; ///< ascending node numbers
  std::vector<std::array<int, 4>> faces; ///< around the face, seen from outside anticlockwise
};

/// The grid of cubes or cuboids that a mesh was made from: node (i, j, k) lies at
/// origin + (i, j, k) * spacing, and cells are numbered with x running fastest over the present ones.
struct Grid {
  std::array<int, 3> cells{1, 1, 1};                 ///< along x, y, z, > 0
  Eigen::Vector3d spacing = Eigen::Vector3d::Ones(); ///< mm
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< mm
  std::vector<bool> present;                         ///< x fastest, nx*ny*nz entries; empty: every cell
  std::size_t n_lattice_cells() const;
  bool has(int i, int j, int k) const; ///< false outside the grid
  /// The longest edge of the grid over the second longest. Geometric multigrid takes many iterations to bend
  /// a bar that is more than thin, if it succeeds.
  double slenderness() const;
  static constexpr double thin = 20;
  static constexpr double most_cells = 50e6; ///< in a grid that fills a surface or a picture
};

class Sharing;

/// The body's mesh, which both models are made from.
struct HexMesh {
  RuledList<GridNodes> nodes;              ///< rest positions, mm
  RuledList<GridCells> cells;              ///< vertex v = i + 2j + 4k sits at (i, j, k) in the reference cube
  std::map<std::string, Selection> groups; ///< physical groups of a mesh file
  std::vector<std::string> group_of_cell; ///< name of its three-dimensional physical group; empty: none named
  std::optional<Grid> grid;               ///< set when the mesh is a grid of cells
};

/// The 12 edges, 12 face diagonals and 4 internal diagonals of a cell, and its 6 faces (anticlockwise from
/// outside).
extern const std::array<std::array<int, 2>, 12> cell_edges;
extern const std::array<std::array<int, 2>, 12> cell_face_diagonals;
extern const std::array<std::array<int, 2>, 4> cell_internal_diagonals;
extern const std::array<std::array<int, 4>, 6> cell_faces; ///< x-, x+, y-, y+, z-, z+

/// A cell's vertices as gmsh, VTK and CalculiX number them: around its bottom, then around its top.
constexpr std::array<std::size_t, 8> around_cell{0, 1, 3, 2, 4, 5, 7, 6};

/// The same cells without the empty layers around them: fields on a grid have numbers for what is empty too.
Grid cropped(const Grid& grid);

/// The present cells of a grid, in pieces that hang together by faces.
struct Pieces {
  std::vector<int> piece_of_cell; ///< piece at every place of the grid, -1 where no cell is
  std::vector<std::size_t> sizes; ///< cells of each piece
};

/// @param grid  with `present`
Pieces pieces_of(const Grid& grid);

/// Mesh of the present cells of a grid; nodes that no present cell touches are left out, x runs fastest.
/// Where every cell is present, neither nodes nor cells are stored.
HexMesh make_grid_mesh(const Grid& grid);

/// Box from the origin to size (mm), divided into cells.
HexMesh make_box_mesh(const Eigen::Vector3d& size, const std::array<int, 3>& cells);

/// Whether the cells of a mesh are equal cuboids along the axes, however they are numbered and turned; if so,
/// mesh.grid is set, and the cells are put in the order and orientation that Grid asks for. Nodes keep their
/// numbers and positions. Positions may be off by 1e-8 of the spacing, which is what mesh generators leave.
/// @return whether a grid was found
bool find_grid(HexMesh& mesh);

/// Every cell split into eight at its trilinear midpoints, so the body stays the same body. The old nodes
/// keep their numbers; the children of cell c are cells 8c .. 8c+7; groups are refined with it. The result is
/// not numbered like a grid, so its grid is empty.
HexMesh refine(const HexMesh& mesh);

/// Volume of the trilinear hexahedron with these vertices (mm³; negative when inside out), exact (2x2x2
/// Gauss).
double cell_volume(const std::array<Eigen::Vector3d, 8>& vertices);

/// The smallest of the eight corner Jacobian determinants of the map from the unit cube, mm³: not above 0 for
/// an inverted or degenerate cell, not a number where a vertex is none.
double smallest_corner_jacobian(const std::array<Eigen::Vector3d, 8>& vertices);

/// The vertices of one cell, displaced.
/// @param displacement  one per node from the first on, or empty for the rest shape
std::array<Eigen::Vector3d, 8> cell_vertices(const HexMesh& mesh, std::size_t cell,
                                             const std::vector<Eigen::Vector3d>& displacement = {},
                                             std::size_t first_node = 0);

/// Whether each cell that is here is inverted or degenerate.
/// @param sharing  the ranks that share the displacement; null: all of it is here
std::vector<bool> inverted_cells(const HexMesh& mesh, const std::vector<Eigen::Vector3d>& displacement,
                                 const Sharing* sharing = nullptr);
/// Their number on all ranks.
int n_inverted(const HexMesh& mesh, const std::vector<Eigen::Vector3d>& displacement,
               const Sharing* sharing = nullptr);

/// Nodes of a cell's edge, face, ... that is given by its vertices.
template<std::size_t N>
std::array<int, N> pick(const std::array<int, 8>& cell, const std::array<int, N>& vertices) {
  std::array<int, N> nodes;
  for (std::size_t v = 0; v < N; ++v) nodes[v] = cell[index(vertices[v])];
  return nodes;
}

/// The same numbers in ascending order.
template<class Numbers>
Numbers sorted(Numbers numbers) {
  std::sort(numbers.begin(), numbers.end());
  return numbers;
}

/// Sorts a list and leaves every value in it once.
template<class Value>
void make_set(std::vector<Value>& list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

template<class Points>
Eigen::AlignedBox3d bounding_box(const Points& points) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& point : points) box.extend(point);
  return box;
}

/// Mean of the rest positions of a cell's, a face's, ... nodes.
template<class Nodes>
Eigen::Vector3d centre_of(const HexMesh& mesh, const Nodes& nodes) {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (const int node : nodes) centre += mesh.nodes[index(node)] / static_cast<double>(nodes.size());
  return centre;
}

/// Faces that belong to one cell only.
std::vector<std::array<int, 4>> boundary_faces(const HexMesh& mesh);

} // namespace springproof::cases
