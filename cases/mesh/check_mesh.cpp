#include "cases/mesh/read_mesh.hpp"

#include "cases/mesh/cell_point.hpp"

#include <boost/pending/disjoint_sets.hpp>
#include <fmt/format.h>
#include <limits>
#include <stdexcept>
#include <tuple>
#include <unsupported/Eigen/BVH>

namespace springproof::cases {

namespace {

using Eigen::Vector3d;

constexpr double touching = 0.01; ///< part of an edge: what is nearer is meant to meet
constexpr const char* way_out =
    "cells have to meet in whole faces and to share the vertices there: divide all of them alike, and merge "
    "nodes in one place (gmsh: Coherence; before the mesh is made, or Coherence Mesh;). Sides of a crack "
    "that is meant must be more than 1 % of an edge apart";

[[noreturn]] void refuse_mesh(const std::string& reason) {
  throw std::runtime_error(reason);
}

/// Finds the nodes of a tree that are in a box, without a look at most others.
struct NodesInBox {
  const Mesh& mesh;
  Eigen::AlignedBox3d box;
  std::vector<int> found{};
  bool intersectVolume(const Eigen::AlignedBox3d& volume) const { return volume.intersects(box); }
  bool intersectObject(int node) {
    if (box.contains(Vector3d(mesh.nodes[index(node)]))) found.push_back(node);
    return false; // the search goes on
  }
};

class MeshCheck {
 public:
  MeshCheck(const Mesh& mesh, const std::vector<CellFace>& faces, const MeshNumbers& numbers)
      : mesh_(mesh), faces_(faces), numbers_(numbers) {}

  void check() {
    check_cells();
    check_faces();
    check_in_one_piece();
    check_surface();
  }

 private:
  const Mesh& mesh_;
  const ReferenceCell& shape_ = reference_cell(mesh_.shape);
  const std::vector<CellFace>& faces_;
  const MeshNumbers& numbers_;
  std::vector<int> surface_; ///< nodes of faces of one cell

  /// The Jacobian is positive at every corner of a cell that is neither inside out nor folded.
  void check_cells() const {
    std::vector<std::size_t> inverted;
    for (std::size_t c = 0; c < mesh_.cells.size(); ++c)
      if (!(smallest_corner_jacobian(cell_corners(mesh_, c)) > 0)) inverted.push_back(numbers_.of_cells[c]);
    if (inverted.empty()) return;
    const std::size_t n_shown = std::min<std::size_t>(5, inverted.size());
    refuse_mesh(fmt::format(
        "{} of {} {} are inverted or degenerate (a corner whose Jacobian is not positive): "
        "elements {}{}",
        inverted.size(), mesh_.cells.size(), shape_.names,
        fmt::join(inverted.data(), inverted.data() + n_shown, " "), inverted.size() > n_shown ? " ..." : ""));
  }

  /// A face is one cell's, or lies between two, which see it from opposite sides.
  void check_faces() {
    for (std::size_t f = 0; f < faces_.size();) {
      std::size_t end = f + 1;
      while (end < faces_.size() && faces_[end].vertices == faces_[f].vertices) ++end;
      if (end - f == 1) surface_.insert(surface_.end(), faces_[f].around.begin(), faces_[f].around.end());
      if (end - f > 2 || (end - f == 2 && is_same_way(faces_[f].around, faces_[f + 1].around)))
        refuse_at_face(f, end);
      f = end;
    }
    make_set(surface_);
  }

  static bool is_same_way(const FaceNodes& a, FaceNodes b) {
    std::rotate(b.begin(), std::find(b.begin(), b.end(), a[0]), b.end());
    return a == b;
  }

  [[noreturn]] void refuse_at_face(std::size_t f, std::size_t end) const {
    for (std::size_t a = f; a < end; ++a)
      for (std::size_t b = a + 1; b < end; ++b)
        if (sorted(mesh_.cells[faces_[a].cell]) == sorted(mesh_.cells[faces_[b].cell]))
          refuse_mesh(fmt::format("elements {} and {} are one {}, which must be listed once",
                                  element(faces_[a].cell), element(faces_[b].cell), shape_.name));
    std::vector<std::size_t> elements;
    for (std::size_t a = f; a < end; ++a) elements.push_back(element(faces_[a].cell));
    const std::string all = fmt::format("{}", fmt::join(elements, ", "));
    refuse_mesh(fmt::format("the face of nodes {} belongs to elements {}{}", nodes_of(faces_[f].around), all,
                            end - f > 2 ? ", must belong to one or two"
                                        : ", which lie on the same side of it and overlap"));
  }

  /// A piece that shares no node with the rest is unconstrained: most often coincident nodes were not merged.
  void check_in_one_piece() const {
    boost::disjoint_sets_with_storage<> pieces(mesh_.nodes.size());
    for (const auto& cell : mesh_.cells)
      for (const int node : cell) pieces.union_set(index(cell[0]), index(node));
    std::size_t n_pieces = 0;
    for (std::size_t n = 0; n < mesh_.nodes.size(); ++n) n_pieces += pieces.find_set(n) == n;
    if (n_pieces != 1)
      refuse_mesh(
          fmt::format("falls into {} pieces that share no node; where they touch, merge their nodes (gmsh: "
                      "Coherence Mesh)",
                      n_pieces));
  }

  /// A node on a cell without being its vertex.
  struct Stray {
    int node;
    std::size_t cell;
    Vector3d at; ///< in the reference cell
  };

  /// Checks that nodes of the surface lie only on cells that they are vertices of.
  void check_surface() const {
    std::vector<double> shortest(mesh_.nodes.size(), std::numeric_limits<double>::infinity()),
        of_cell; ///< edge, of nodes and cells
    for (const CellNodes& cell : mesh_.cells) {
      of_cell.push_back(std::numeric_limits<double>::infinity());
      for (const auto& edge : shape_.edges) {
        const auto [a, b] = pick(cell, edge);
        const double length = (mesh_.nodes[index(a)] - mesh_.nodes[index(b)]).norm();
        for (double* least : {&shortest[index(a)], &shortest[index(b)], &of_cell.back()})
          *least = std::min(*least, length);
      }
    }
    std::vector<Eigen::AlignedBox3d> places;
    for (const int node : surface_) places.emplace_back(Vector3d(mesh_.nodes[index(node)]));
    const Eigen::KdBVH<double, 3, int> tree(surface_.begin(), surface_.end(), places.begin(), places.end());
    std::vector<Stray> strays;
    for (std::size_t c = 0; c < mesh_.cells.size(); ++c) {
      const CellNodes cell = mesh_.cells[c];
      const CellCorners vertices = cell_corners(mesh_, c);
      const Eigen::AlignedBox3d box = bounding_box(vertices);
      const Vector3d aside = Vector3d::Constant(touching * of_cell[c]);
      NodesInBox near{mesh_, {box.min() - aside, box.max() + aside}};
      Eigen::BVIntersect(tree, near);
      for (const int node : sorted(near.found)) {
        if (std::find(cell.begin(), cell.end(), node) != cell.end()) continue;
        const Vector3d point = mesh_.nodes[index(node)];
        const auto place = place_in_cell(vertices, point);
        if (!place) continue;
        const Vector3d nearest = moved_inside(mesh_.shape, *place);
        if ((image(vertices, nearest) - point).norm() <=
            touching * std::min(of_cell[c], shortest[index(node)]))
          strays.push_back({node, c, nearest});
      }
    }
    if (!strays.empty()) refuse_strays(strays);
  }

  [[noreturn]] void refuse_strays(const std::vector<Stray>& strays) const {
    const auto largest_share = [this](const Stray& stray) { // the vertex that has it
      const ShapeValues shape = shape_values(mesh_.shape, stray.at);
      return std::max_element(shape.begin(), shape.end()) - shape.begin();
    };
    const auto is_at_vertex = [&](const Stray& stray) {
      return shape_values(mesh_.shape, stray.at)[index(largest_share(stray))] >= 1 - 3 * touching;
    };
    std::vector<int> nodes;
    const Stray* first = nullptr; // first that hangs; if none does, first that lies where a vertex is
    for (const Stray& stray : strays) {
      nodes.push_back(stray.node);
      if (first == nullptr || (is_at_vertex(*first) && !is_at_vertex(stray))) first = &stray;
    }
    make_set(nodes);
    const CellNodes cell = mesh_.cells[first->cell];
    std::string where;
    if (is_at_vertex(*first)) {
      where = fmt::format("in the place of node {}, a vertex", node(cell[index(largest_share(*first))]));
    } else {
      const int face = face_at(mesh_.shape, first->at, touching);
      where = face < 0
                  ? "inside"
                  : fmt::format("on the face of nodes {}", nodes_of(pick(cell, shape_.faces[index(face)])));
    }
    const Vector3d point = mesh_.nodes[index(first->node)];
    refuse_mesh(fmt::format("node {} at ({:.6g}, {:.6g}, {:.6g}) lies {} of element {}, and is no vertex of "
                            "it{}: {}",
                            node(first->node), point.x(), point.y(), point.z(), where, element(first->cell),
                            nodes.size() > 1 ? fmt::format(" ({} nodes are like that)", nodes.size()) : "",
                            way_out));
  }

  std::size_t node(int n) const { return numbers_.of_nodes[index(n)]; }
  std::size_t element(std::size_t cell) const { return numbers_.of_cells[cell]; }
  std::string nodes_of(const FaceNodes& face) const {
    std::vector<std::size_t> numbers;
    for (const int n : face) numbers.push_back(node(n));
    return fmt::format("{}", fmt::join(numbers, " "));
  }
};

} // namespace

std::vector<CellFace> faces_of_cells(const Mesh& mesh) {
  std::vector<CellFace> faces;
  faces.reserve(6 * mesh.cells.size());
  std::size_t number = 0;
  for (const CellNodes& cell : mesh.cells) {
    for (const FaceNodes& local : reference_cell(mesh.shape).faces) {
      const FaceNodes around = pick(cell, local);
      faces.push_back({sorted(around), number, around});
    }
    ++number;
  }
  std::sort(faces.begin(), faces.end(), [](const CellFace& a, const CellFace& b) {
    return std::tie(a.vertices, a.cell) < std::tie(b.vertices, b.cell);
  });
  return faces;
}

void check_mesh(const Mesh& mesh, const std::vector<CellFace>& faces, const MeshNumbers& numbers) {
  MeshCheck(mesh, faces, numbers).check();
}

} // namespace springproof::cases
