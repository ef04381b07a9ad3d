#pragma once

#include <Eigen/Core>
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
  using Value = std::array<int, 8>;
  std::array<int, 3> cells{}; ///< along x, y, z; 0: none

  std::size_t size() const {
    std::size_t n = 1;
    for (const int along : cells) n *= static_cast<std::size_t>(along);
    return n;
  }
  std::array<int, 8> operator[](std::size_t cell) const {
    const auto in_row = static_cast<std::size_t>(cells[0]), rows = static_cast<std::size_t>(cells[1]);
    const int row = cells[0] + 1, layer = row * (cells[1] + 1);
    const int first = static_cast<int>(cell % in_row) + row * static_cast<int>(cell / in_row % rows) +
                      layer * static_cast<int>(cell / in_row / rows);
    std::array<int, 8> vertices{};
    for (int v = 0; v < 8; ++v)
      vertices[static_cast<std::size_t>(v)] = first + (v & 1) + ((v >> 1) & 1) * row + (v >> 2) * layer;
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
