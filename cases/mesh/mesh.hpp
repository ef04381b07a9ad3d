#pragma once

#include "cases/mesh/cell_shape.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace springproof::cases {

/// Places of the nodes of a grid whose cells are all present, x fastest.
struct GridNodes {
  using Value = Eigen::Vector3d;
  std::array<int, 3> cells{}; ///< along x, y, z; 0: no nodes
  Eigen::Vector3d origin = Eigen::Vector3d::Zero(), step = Eigen::Vector3d::Zero(); ///< mm
  Eigen::Vector3d far_corner = Eigen::Vector3d::Zero(); ///< mm, where the last nodes lie: n * step is rounded

  std::size_t size() const {
    std::size_t n = 1;
    for (const int along : cells) n *= along == 0 ? 0 : static_cast<std::size_t>(along) + 1;
    return n;
  }
  Eigen::Vector3d operator[](std::size_t node) const {
    Eigen::Vector3d at;
    for (std::size_t a = 0; a < 3; ++a) {
      const auto n_cells = static_cast<std::size_t>(cells[a]), n = a == 2 ? node : node % (n_cells + 1);
      const auto axis = static_cast<Eigen::Index>(a);
      at[axis] = n == n_cells ? far_corner[axis] : origin[axis] + static_cast<double>(n) * step[axis];
      node /= n_cells + 1;
    }
    return at;
  }
};

/// Vertices of its cells.
struct GridCells {
  using Value = CellNodes;
  std::array<int, 3> cells{}; ///< along x, y, z; 0: none

  std::size_t size() const {
    std::size_t n = 1;
    for (const int along : cells) n *= static_cast<std::size_t>(along);
    return n;
  }
  CellNodes operator[](std::size_t cell) const {
    const auto in_row = static_cast<std::size_t>(cells[0]), rows = static_cast<std::size_t>(cells[1]);
    const int row = cells[0] + 1, layer = row * (cells[1] + 1);
    const int first = static_cast<int>(cell % in_row) + row * static_cast<int>(cell / in_row % rows) +
                      layer * static_cast<int>(cell / in_row / rows);
    CellNodes vertices;
    for (int v = 0; v < 8; ++v) vertices.push_back(first + (v & 1) + ((v >> 1) & 1) * row + (v >> 2) * layer);
    return vertices;
  }
};

/// A list of values that are stored or, where a rule gives them, need no memory. Elements are values, not
/// references: an Eigen expression of one must not outlive its statement; they are constant, so that what
/// would change a copy does not compile.
template<class Rule>
class RuledList {
 public:
  using value_type = typename Rule::Value;

  std::vector<value_type> values; ///< none where there is a rule
  std::optional<Rule> rule;

  RuledList() = default;
  RuledList(std::vector<value_type> the_values) : values(std::move(the_values)) {}
  explicit RuledList(const Rule& the_rule) : rule(the_rule) {}

  std::size_t size() const { return rule ? rule->size() : values.size(); }
  bool empty() const { return size() == 0; }
  const value_type operator[](std::size_t i) const { return rule ? (*rule)[i] : values[i]; }
  const value_type front() const { return (*this)[0]; }
  const value_type back() const { return (*this)[size() - 1]; }

  class Iterator {
   public:
    using iterator_category = std::forward_iterator_tag;
    using value_type = typename Rule::Value;
    using difference_type = std::ptrdiff_t;
    using pointer = void;
    using reference = value_type;

    Iterator(const RuledList& list, std::size_t i) : list_(&list), i_(i) {}
    value_type operator*() const { return (*list_)[i_]; }
    Iterator& operator++() {
      ++i_;
      return *this;
    }
    bool operator==(const Iterator& other) const { return i_ == other.i_; }
    bool operator!=(const Iterator& other) const { return i_ != other.i_; }
    std::size_t number() const { return i_; } ///< in the list

   private:
    const RuledList* list_;
    std::size_t i_;
  };
  Iterator begin() const { return {*this, 0}; }
  Iterator end() const { return {*this, size()}; }

  /// The values for changes; from now on they are stored.
  std::vector<value_type>& stored() {
    if (rule) values = to_vector();
    rule.reset();
    return values;
  }
  std::vector<value_type> to_vector() const {
    std::vector<value_type> all;
    all.reserve(size());
    for (const value_type& value : *this) all.push_back(value);
    return all;
  }
};

/// Converts the number of a node, a cell, ..., which is not negative, to the containers' index type.
inline std::size_t index(std::ptrdiff_t i) {
  return static_cast<std::size_t>(i);
}

/// What a region of a mesh selects. Faces and edges are given by their vertices, so that an element with
/// nodes on them (a quadratic one) can constrain those too. Nodes are sorted and unique.
struct Selection {
  std::vector<int> nodes;
  std::vector<std::array<int, 2>> edges; ///< ascending node numbers
  std::vector<FaceNodes> faces;          ///< around the face, seen from outside anticlockwise
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

/// The body's mesh, which both models are made from. All its cells are of one shape. A network of springs has
/// no cells, and so no faces and no volume: what is asked of these is refused before anything is solved.
struct Mesh {
  CellShape shape = CellShape::hexahedron; ///< without meaning where there are no cells
  RuledList<GridNodes> nodes;              ///< rest positions, mm
  RuledList<GridCells> cells;              ///< in the order of the reference cell's vertices
  std::map<std::string, Selection> groups; ///< physical groups of a mesh file
  std::vector<std::string> group_of_cell; ///< name of its three-dimensional physical group; empty: none named
  std::optional<Grid> grid;               ///< set when the mesh is a grid of hexahedra
  std::vector<std::array<int, 2>> lines{}; ///< where there are no cells: what is drawn in their place
};

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
Mesh make_grid_mesh(const Grid& grid);

/// Box from the origin to size (mm), divided into cells.
Mesh make_box_mesh(const Eigen::Vector3d& size, const std::array<int, 3>& cells);

/// Whether the cells of a mesh are equal cuboids along the axes, however they are numbered and turned; if so,
/// mesh.grid is set, and the cells are put in the order and orientation that Grid asks for. Nodes keep their
/// numbers and positions. Positions may be off by 1e-8 of the spacing, which is what mesh generators leave.
/// @return whether a grid was found
bool find_grid(Mesh& mesh);

/// Every cell split into eight: a hexahedron at its trilinear midpoints, a tetrahedron at those of its edges
/// (red refinement, in the order of Bey 1995, which makes no worse shapes than three). So the body stays the
/// same body. The old nodes keep their numbers; the children of cell c are cells 8c .. 8c+7; groups are
/// refined with it. The result is not numbered like a grid, so its grid is empty.
Mesh refine(const Mesh& mesh);

/// The children of a tetrahedron, their vertices given by the two whose midpoint each of them is.
extern const std::array<std::array<std::array<int, 2>, 4>, 8> tetrahedron_children;

/// The vertices of one cell, displaced.
/// @param displacement  one per node from the first on, or empty for the rest shape
CellCorners cell_corners(const Mesh& mesh, std::size_t cell,
                         const std::vector<Eigen::Vector3d>& displacement = {}, std::size_t first_node = 0);

/// A hexahedron's vertices by number.  @param nodes  eight
inline std::array<int, 8> hexahedron_nodes(const CellNodes& nodes) {
  std::array<int, 8> vertices{};
  std::copy_n(nodes.begin(), 8, vertices.begin());
  return vertices;
}
/// The same as cell_corners() in a mesh of hexahedra.
std::array<Eigen::Vector3d, 8> cell_vertices(const Mesh& mesh, std::size_t cell,
                                             const std::vector<Eigen::Vector3d>& displacement = {},
                                             std::size_t first_node = 0);

/// Whether each cell that is here is inverted or degenerate.
/// @param sharing  the ranks that share the displacement; null: all of it is here
std::vector<bool> inverted_cells(const Mesh& mesh, const std::vector<Eigen::Vector3d>& displacement,
                                 const Sharing* sharing = nullptr);
/// Their number on all ranks.
int n_inverted(const Mesh& mesh, const std::vector<Eigen::Vector3d>& displacement,
               const Sharing* sharing = nullptr);

/// Nodes of a cell's edge, face, ... that is given by its vertices.
template<class Vertices, class Nodes>
Vertices pick(const Nodes& cell, Vertices vertices) {
  for (int& v : vertices) v = cell[index(v)];
  return vertices;
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
Eigen::Vector3d centre_of(const Mesh& mesh, const Nodes& nodes) {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (const int node : nodes) centre += mesh.nodes[index(node)] / static_cast<double>(nodes.size());
  return centre;
}

/// The sides of a face, each from one vertex to the next one around it.
inline std::vector<std::array<int, 2>> sides_of(const FaceNodes& face) {
  std::vector<std::array<int, 2>> sides;
  for (std::size_t v = 0; v < face.size(); ++v) sides.push_back({face[v], face[(v + 1) % face.size()]});
  return sides;
}

/// Faces that belong to one cell only.
std::vector<FaceNodes> boundary_faces(const Mesh& mesh);

} // namespace springproof::cases
