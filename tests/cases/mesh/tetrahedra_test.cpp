#include "cases/mesh/cell_point.hpp"
#include "cases/mesh/read_mesh.hpp"
#include "tests/support/mesh_volume.hpp"
#include "tests/support/tetrahedra.hpp"

#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <set>

using namespace springproof;

using namespace cases;
using Eigen::Vector3d;

namespace {

constexpr double rounding = 1e-13;

/// Volume over the cube of the longest edge.
double quality(const CellCorners& corners) {
  double longest = 0;
  for (const auto& [a, b] : reference_cell(CellShape::tetrahedron).edges)
    longest = std::max(longest, (corners[index(a)] - corners[index(b)]).norm());
  return cell_volume(corners) / std::pow(longest, 3);
}

} // namespace

TEST_CASE("faces of the reference cells look outwards, and each shape's functions are 1 at one vertex") {
  for (const CellShape shape : {CellShape::hexahedron, CellShape::tetrahedron}) {
    const ReferenceCell& cell = reference_cell(shape);
    CellCorners corners;
    for (std::size_t v = 0; v < cell.n_vertices; ++v)
      corners.push_back(shape == CellShape::hexahedron ? Vector3d(v & 1U, v >> 1U & 1U, v >> 2U)
                        : v == 0                       ? Vector3d(0, 0, 0)
                                                       : Vector3d(v == 1, v == 2, v == 3));
    CHECK(cell_volume(corners) == Approx(cell.volume).epsilon(rounding));
    for (std::size_t v = 0; v < cell.n_vertices; ++v) {
      const ShapeValues values = shape_values(shape, corners[v]);
      for (std::size_t w = 0; w < cell.n_vertices; ++w) CHECK(values[w] == (v == w ? 1 : 0));
      CHECK(image(corners, corners[v]) == corners[v]);
    }
    Vector3d centre = Vector3d::Zero();
    for (const Vector3d& corner : corners) centre += corner / double(cell.n_vertices);
    double volume = 0; // by the divergence theorem
    for (std::size_t f = 0; f < cell.faces.size(); ++f) {
      const FaceNodes& face = cell.faces[f];
      const Vector3d a = corners[index(face[0])], b = corners[index(face[1])], c = corners[index(face[2])];
      CHECK((b - a).cross(c - a).dot(a - centre) > 0);
      Vector3d middle = Vector3d::Zero();
      for (const int v : face) middle += corners[index(v)] / double(face.size());
      CHECK(face_at(shape, middle, 1e-12) == int(f));
      const double area = (b - a).cross(c - a).norm() / (face.size() == 3 ? 2 : 1);
      volume += area * (b - a).cross(c - a).normalized().dot(middle) / 3;
    }
    CHECK(volume == Approx(cell.volume).epsilon(rounding));
  }
}

TEST_CASE("refined tetrahedra fill the body, meet in whole faces and get no worse after the second time",
          "[verification]") {
  const Mesh mesh = bodies::box_of_tetrahedra({2, 3, 1});
  const Mesh fine = refine(mesh), finer = refine(fine), finest = refine(finer);
  CHECK(volume_of(mesh) == Approx(6 * 1.3).epsilon(rounding)); // the shear's determinant is 1.3
  for (const Mesh* refined : {&fine, &finer, &finest}) {
    CHECK(volume_of(*refined) == Approx(volume_of(mesh)).epsilon(1e-12)); // a sum over thousands
    MeshNumbers numbers;
    for (std::size_t n = 0; n < refined->nodes.size(); ++n) numbers.of_nodes.push_back(n);
    for (std::size_t c = 0; c < refined->cells.size(); ++c) numbers.of_cells.push_back(c);
    CHECK_NOTHROW(check_mesh(*refined, faces_of_cells(*refined), numbers));
  }
  CHECK(finest.cells.size() == 512 * mesh.cells.size());
  CHECK(boundary_faces(fine).size() == 4 * boundary_faces(mesh).size());
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n) CHECK(fine.nodes[n] == mesh.nodes[n]);
  const auto shapes = [](const Mesh& refined, std::size_t cell, std::size_t n) {
    std::set<long> found; // to six digits
    for (std::size_t child = n * cell; child < n * (cell + 1); ++child)
      found.insert(std::lround(1e6 * quality(cell_corners(refined, child))));
    return found;
  };
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    CHECK(shapes(finest, c, 512).size() <= 3); // Bey 1995
    CHECK(shapes(finest, c, 512) == shapes(finer, c, 64));
  }
}

TEST_CASE(
    "a point of a tetrahedron is found, weighs its vertices and stays where it is when cells are halved",
    "[verification]") {
  const Mesh mesh = bodies::box_of_tetrahedra({2, 3, 1}), fine = refine(mesh);
  Eigen::Matrix3d gradient;
  gradient << 0.1, -0.3, 0.2, 0.05, 0.4, -0.1, 0.3, 0.2, -0.2;
  const auto moved = [&](const Mesh& on, const CellPoint& point) {
    Vector3d sum = Vector3d::Zero();
    for (const auto& [node, weight] : on_nodes({{point, 1.}}, on))
      sum += weight * (gradient * on.nodes[index(node)]);
    return sum;
  };
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    for (const Vector3d& at :
         {Vector3d(0.25, 0.25, 0.25), Vector3d(0.1, 0.7, 0.15), Vector3d(0.45, 0.08, 0.4)}) {
      CAPTURE(c, at.transpose());
      const Vector3d place = image(cell_corners(mesh, c), at);
      CHECK(cells_at(mesh, place) == std::vector{c});
      const CellPoint point{c, at, Vector3d(0.02, -0.01, 0.03)};
      const CellPoint in_child = refine(mesh.shape, point);
      CHECK(in_child.cell / 8 == c);
      CHECK((image(cell_corners(fine, in_child.cell), in_child.at) - place).norm() < 1e-12);
      const Vector3d beyond = jacobian(cell_corners(mesh, c), at) * point.beyond;
      CHECK((moved(mesh, point) - gradient * (place + beyond)).norm() < 1e-12);
      CHECK((moved(fine, in_child) - gradient * (place + beyond)).norm() < 1e-12);
    }
  CHECK(cells_at(mesh, {-1, 0, 0}).empty());
  CHECK(cells_at(mesh, mesh.nodes[0]).size() == 6);
}
