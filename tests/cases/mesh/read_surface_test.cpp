#include "cases/mesh/vtk_functions.hpp"

#include "cases/mesh/voxels.hpp"
#include "tests/support/case_text.hpp"

#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <cmath>

using namespace springproof;

using namespace cases;
using Eigen::Vector3d;

namespace {

/// A ball of radius 8 about (12, 11, 10) in a picture of points 1 mm apart: its mask, or its depth in mm.
Picture ball(bool is_mask, double radius = 8) {
  Picture picture{{25, 23, 21}, {0, 0, 0}, {1, 1, 1}, {}};
  for (int k = 0; k < 21; ++k)
    for (int j = 0; j < 23; ++j)
      for (int i = 0; i < 25; ++i) {
        const double depth = radius - (Vector3d(i, j, k) - Vector3d(12, 11, 10)).norm();
        picture.values.push_back(static_cast<float>(is_mask ? depth > 0 : depth));
      }
  return picture;
}

double volume_of(const TriangleMesh& mesh) {
  double volume = 0;
  for (const auto& triangle : mesh.triangles)
    volume += doubled_area(triangle, mesh.vertices).dot(barycentre(triangle, mesh.vertices)) / 6;
  return volume;
}

const std::string polygons = R"(<VTKFile type="PolyData" version="0.1" byte_order="LittleEndian"><PolyData>
<Piece NumberOfPoints="5" NumberOfVerts="0" NumberOfLines="0" NumberOfStrips="0" NumberOfPolys="2">
<Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">0 0 0 1 0 0 1 1 0 0 1 0 0.5 0.5 1</DataArray></Points>
<Polys><DataArray type="Int32" Name="connectivity" format="ascii">0 1 2 3 0 1 4</DataArray>
<DataArray type="Int32" Name="offsets" format="ascii">4 7</DataArray></Polys></Piece></PolyData></VTKFile>
)";

} // namespace

TEST_CASE("the contour of a ball is closed, looks outwards and has its volume", "[verification]") {
  const double exact = 4 * std::acos(-1.0) / 3 * 512;
  const TriangleMesh smooth = contour(ball(false), {0, 0, 0});
  CHECK(n_open_edges(smooth) == 0);
  CHECK(volume_of(smooth) == Approx(exact).epsilon(0.01)); // second order in 1 mm over a radius of 8
  for (const Vector3d& vertex : smooth.vertices) // a linear profile errs along edges by curvature: h²/(8 r)
    REQUIRE(std::abs((vertex - Vector3d(12, 11, 10)).norm() - 8) < 1. / (8 * 8));
  CHECK(volume_of(contour(ball(true), {0.5, 20, 0})) == Approx(exact).epsilon(0.05)); // steps of 1 mm
}

TEST_CASE("a contour of fewer triangles is closed and keeps the volume") {
  const TriangleMesh all = contour(ball(false), {0, 0, 0}), fewer = contour(ball(false), {0, 0, 600});
  REQUIRE(all.triangles.size() > 1500);
  CHECK(fewer.triangles.size() <= 600);
  CHECK(fewer.triangles.size() > 500);
  CHECK(n_open_edges(fewer) == 0);
  CHECK(volume_of(fewer) == Approx(volume_of(all)).epsilon(0.01));
}

TEST_CASE("a surface of fewer triangles is closed, looks outwards and stays where it was") {
  const TriangleMesh fine = contour(ball(false), {0, 0, 0}), coarse = decimated(fine, 300);
  CHECK(coarse.triangles.size() <= 300);
  CHECK(coarse.triangles.size() > 200);
  CHECK(n_open_edges(coarse) == 0);
  CHECK(volume_of(coarse) == Approx(volume_of(fine)).epsilon(0.05));
  for (const Vector3d& vertex : coarse.vertices)
    REQUIRE(std::abs((vertex - Vector3d(12, 11, 10)).norm() - 8) < 0.5); // edges of 2.5 mm or so
  CHECK(decimated(coarse, 300).triangles.size() == coarse.triangles.size());
  CHECK_THROWS_WITH(decimated({}, 300), "has no triangles");
}

TEST_CASE("a body that reaches the borders of its picture has a closed contour") {
  const TriangleMesh cut = contour(ball(true, 12), {0.5, 0, 0});
  CHECK(n_open_edges(cut) == 0);
  CHECK(volume_of(cut) > 0);
}

TEST_CASE("a picture without a contour, and one of other sizes, are refused") {
  CHECK_THROWS_WITH(contour(ball(true), {1.5, 0, 0}), Catch::Contains("no triangles"));
  Picture broken = ball(true);
  broken.values.pop_back();
  CHECK_THROWS_WITH(contour(broken, {}), Catch::Contains("as many values"));
  CHECK_THROWS_WITH(contour({{0, 1, 1}, {0, 0, 0}, {1, 1, 1}, {}}, {}), Catch::Contains("as many values"));
}

TEST_CASE("polygons of a .vtp become triangles with common vertices, and broken files are refused") {
  const TemporaryFolder folder;
  const TriangleMesh mesh = read_surface(folder.write("a.vtp", polygons));
  CHECK(mesh.vertices.size() == 5);
  CHECK(mesh.triangles.size() == 3);
  for (const auto& [text, says] : std::vector<std::pair<std::string, std::string>>{
           {case_text::replaced(polygons, "0.5 0.5 1<", "0.5 0.5 inf<"), "too short"},
           {case_text::replaced(polygons, "0 1 2 3 0 1 4", "0 1 2 3 0 1 99"), "does not exist"},
           {case_text::replaced(polygons, "0 1 2 3 0 1 4", "0 1 2 3 0 1 -1"), "does not exist"},
           {case_text::replaced(polygons, ">4 7<", ">4 900<"), ""},
           {case_text::replaced(polygons, "NumberOfPolys=\"2\"", "NumberOfPolys=\"0\""), "no triangles"},
           {"", ""},
           {polygons.substr(0, 300), ""}}) {
    CAPTURE(text);
    CHECK_THROWS_WITH(read_surface(folder.write("bad.vtp", text)), Catch::Contains(says));
  }
}
