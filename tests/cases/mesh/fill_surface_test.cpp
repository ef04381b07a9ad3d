#include "cases/mesh/fill_surface.hpp"

#include "tests/support/mesh_volume.hpp"
#include "tests/support/temporary_folder.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>

using namespace springproof;

using namespace cases;
using Catch::Contains;
using Eigen::Vector3d;

namespace {

struct Polygons {
  std::vector<Vector3d> vertices;
  std::vector<std::vector<int>> faces; ///< anticlockwise from outside
};

const Polygons cube_of_polygons{
    {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}},
    {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 4, 7, 3}, {1, 2, 6, 5}}};

/// An ellipsoid of 40 x 30 x 20 mm between its lines of longitude and latitude.
Polygons ellipsoid_of_polygons() {
  constexpr int n_around = 24, n_rings = 11;
  Polygons body;
  const double pi = std::acos(-1.0);
  const auto at = [&](int ring, int around) {
    const double theta = pi * (ring + 1) / (n_rings + 1), phi = 2 * pi * around / n_around;
    return Vector3d(20 * std::sin(theta) * std::cos(phi), 15 * std::sin(theta) * std::sin(phi),
                    10 * std::cos(theta));
  };
  for (int r = 0; r < n_rings; ++r)
    for (int a = 0; a < n_around; ++a) body.vertices.push_back(at(r, a));
  const int top = n_rings * n_around;
  body.vertices.emplace_back(0, 0, 10);
  body.vertices.emplace_back(0, 0, -10);
  for (int a = 0; a < n_around; ++a) {
    const int next = (a + 1) % n_around, last = (n_rings - 1) * n_around;
    body.faces.push_back({top, a, next});
    body.faces.push_back({top + 1, last + next, last + a});
    for (int r = 0; r + 1 < n_rings; ++r)
      body.faces.push_back(
          {r * n_around + a, (r + 1) * n_around + a, (r + 1) * n_around + next, r * n_around + next});
  }
  return body;
}

/// A torus whose tube is wider than its ring: it crosses itself.
Polygons spindle() {
  constexpr int n = 40;
  Polygons body;
  const double turn = 2 * std::acos(-1.0) / n;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double from_axis = 3 + 4 * std::cos(turn * j);
      body.vertices.emplace_back(from_axis * std::cos(turn * i), from_axis * std::sin(turn * i),
                                 4 * std::sin(turn * j));
      const int next_i = (i + 1) % n * n, next_j = (j + 1) % n;
      body.faces.push_back({n * i + j, next_i + j, next_i + next_j});
      body.faces.push_back({n * i + j, next_i + next_j, n * i + next_j});
    }
  return body;
}

std::string as_obj(const Polygons& body) {
  std::string text;
  for (const Vector3d& v : body.vertices) text += fmt::format("v {}\n", fmt::join(v, " "));
  for (const auto& face : body.faces) {
    text += "f";
    for (const int v : face) text += fmt::format(" {}", v + 1);
    text += "\n";
  }
  return text;
}

std::string as_ply(const Polygons& body) {
  std::string text =
      fmt::format("ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float y\n"
                  "property float z\nelement face {}\nproperty list uchar int vertex_indices\n"
                  "end_header\n",
                  body.vertices.size(), body.faces.size());
  for (const Vector3d& v : body.vertices) text += fmt::format("{}\n", fmt::join(v, " "));
  for (const auto& face : body.faces) text += fmt::format("{} {}\n", face.size(), fmt::join(face, " "));
  return text;
}

std::string as_stl(const Polygons& body) {
  std::string text = "solid body\n";
  for (const auto& face : body.faces)
    for (std::size_t v = 1; v + 1 < face.size(); ++v) {
      text += "facet normal 0 0 0\nouter loop\n";
      for (const std::size_t corner : {std::size_t{0}, v, v + 1})
        text += fmt::format("vertex {}\n", fmt::join(body.vertices[index(face[corner])], " "));
      text += "endloop\nendfacet\n";
    }
  return text + "endsolid\n";
}

Mesh filled(const std::string& name, const std::string& text, double size, Fill by = Fill::tetrahedra,
            std::vector<std::string>* remarks = nullptr, double scale = 1) {
  const TemporaryFolder folder;
  std::vector<std::string> found;
  Mesh mesh =
      fill_surface({{folder.write(name, text), {"case.toml", 6, 8, "body.file"}}, size, by, scale}, found);
  if (remarks) *remarks = found;
  return mesh;
}

void check_not_filled(const std::string& name, const std::string& text, double size,
                      const std::string& reason) {
  INFO(reason);
  try {
    filled(name, text, size);
    FAIL("was filled");
  } catch (const InputError& error) {
    CHECK_THAT(error.what(), Catch::StartsWith("case.toml:6:8: body.file: ") && Contains(reason));
    CHECK(std::string(error.what()).find('\n') == std::string::npos);
  }
}

} // namespace

TEST_CASE("a cube in every format is filled with tetrahedra that have its volume, the same each time") {
  for (const auto& [name, text] : {std::pair{"a.obj", as_obj(cube_of_polygons)},
                                   {"a.ply", as_ply(cube_of_polygons)},
                                   {"a.stl", as_stl(cube_of_polygons)}}) {
    INFO(name);
    std::vector<std::string> remarks;
    const Mesh mesh = filled(name, text, 0.3, Fill::tetrahedra, &remarks);
    CHECK(mesh.shape == CellShape::tetrahedron);
    CHECK(mesh.cells.size() > 100);
    CHECK(volume_of(mesh) == Approx(1).epsilon(1e-6)); // single precision in the files
    CHECK_THAT(remarks.back(), Contains("of its 1 mm3"));
    CHECK(bounding_box(mesh.nodes).sizes().isApprox(Vector3d(1, 1, 1), 1e-6));
    const Mesh again = filled(name, text, 0.3);
    CHECK(again.nodes.to_vector() == mesh.nodes.to_vector());
    CHECK(again.cells.to_vector() == mesh.cells.to_vector());
  }
}

TEST_CASE("an ellipsoid in metres is filled near its surface, and finer cells are nearer") {
  Polygons body = ellipsoid_of_polygons();
  double enclosed = 0; // by its polygons, which are plane to rounding
  for (const auto& face : body.faces)
    for (std::size_t v = 1; v + 1 < face.size(); ++v)
      enclosed += body.vertices[index(face[0])].dot(
                      body.vertices[index(face[v])].cross(body.vertices[index(face[v + 1])])) /
                  6;
  for (Vector3d& vertex : body.vertices) vertex /= 1000;
  double before = 1;
  for (const double size : {8., 4., 2.}) {
    std::vector<std::string> remarks;
    const Mesh mesh = filled("a.stl", as_stl(body), size, Fill::tetrahedra, &remarks, 1000);
    const double off = std::abs(volume_of(mesh) / enclosed - 1);
    CHECK(off < before);
    before = off;
    CHECK_THAT(remarks.back(),
               Contains("tetrahedra fill") && Contains("limits are those of the cells' body"));
  }
  CHECK(before <
        0.01); // facets of 2 mm on radii from 5 mm on: (2/5)²/8 of a radius at most, where it is sharpest
  std::vector<std::string> remarks;
  const Mesh cubes = filled("a.obj", as_obj(body), 2, Fill::cubes, &remarks, 1000);
  CHECK(cubes.shape == CellShape::hexahedron);
  CHECK(cubes.grid);
  CHECK_THAT(remarks.back(), Contains("cubes fill"));
}

TEST_CASE("a surface that bounds no body is refused in one line with the remedy") {
  Polygons open = cube_of_polygons, thick = cube_of_polygons;
  open.faces.pop_back();
  check_not_filled("a.obj", as_obj(open), 0.3, "is open: 4 of its edges belong to one triangle");
  check_not_filled("a.obj", as_obj(open), 0.3, "close its holes");
  thick.vertices.emplace_back(0.5, 0.5, 2); // a fin on an edge
  thick.faces.push_back({4, 5, 8});
  thick.faces.push_back({5, 4, 8});
  check_not_filled("a.ply", as_ply(thick), 0.3, "");
  Polygons crossed = cube_of_polygons;
  for (const Vector3d& v : cube_of_polygons.vertices)
    crossed.vertices.emplace_back(v + Vector3d(0.5, 0.4, 0.3));
  for (auto face : cube_of_polygons.faces) {
    for (int& v : face) v += 8;
    crossed.faces.push_back(face);
  }
  check_not_filled("a.obj", as_obj(crossed), 0.3, "it has 2 parts that share no vertex");
  check_not_filled("a.obj", as_obj(crossed), 0.3, "fill = \"cubes\"");
  check_not_filled("a.obj", as_obj(cube_of_polygons), 2, "is smaller than an edge of 2 mm");
  check_not_filled("a.obj", as_obj(cube_of_polygons), 0.001, "must need at most");
  Polygons turned = cube_of_polygons;
  std::reverse(turned.faces[2].begin(), turned.faces[2].end());
  check_not_filled("a.obj", as_obj(turned), 0.3, "has triangles that are turned over: 4 of its edges");
  check_not_filled("a.obj", as_obj(spindle()), 2, "where it crosses or touches itself");
  Polygons flat = cube_of_polygons;
  for (Vector3d& vertex : flat.vertices) vertex.z() = 0;
  check_not_filled("a.obj", as_obj(flat), 0.3, "");
  check_not_filled("a.obj", "", 0.3, "");
  check_not_filled("a.ply", "ply\n", 0.3, "");
  check_not_filled("a.obj", "v 0 0 0\nf 1 2 3\n", 0.3, "");
}
