#include "cases/case/read_case.hpp"
#include "cases/mesh/labels.hpp"
#include "cases/mesh/voxels.hpp"
#include "cases/scene/scene.hpp"
#include "tests/support/case_text.hpp"
#include "tests/support/pictures.hpp"

#include <catch2/catch.hpp>
#include <cstring>

using namespace springproof;

using namespace cases;
using Eigen::Vector3d;

namespace {

const Vector3d ball_centre(11, 12, 11);
constexpr double ball_radius = 8; // mm

/// 30 x 12 x 22 voxels of 1 x 2 x 1 mm: 100 less 10 a mm of the distance from the sphere, and a plate of 200
/// beyond 27 mm of x that does not touch it.
Volume ball_and_plate() {
  Volume volume{{30, 12, 22}, {1, 2, 1}, {}};
  for (int k = 0; k < 22; ++k)
    for (int j = 0; j < 12; ++j)
      for (int i = 0; i < 30; ++i) {
        const double beyond = (Vector3d(i + 0.5, 2 * j + 1, k + 0.5) - ball_centre).norm() - ball_radius;
        volume.intensities.push_back(i >= 27 ? 200 : static_cast<float>(100 - 10 * beyond));
      }
  return volume;
}

Labels largest_piece(double edge) {
  Labels labels;
  labels.edge = edge;
  labels.classes = {{"tissue", 100, 1000, false}};
  labels.keep = Keep::largest;
  return labels;
}

} // namespace

TEST_CASE("the contour of a body's picture is where the intensity is, not where the cells end",
          "[verification]") {
  const TemporaryFolder folder;
  Labels labels = largest_piece(2);
  labels.file.path = folder.write("ball.nii", pictures::nifti_of(ball_and_plate()));
  SECTION("of the whole picture: the sphere, without the plate") {
    const TriangleMesh skin = label_surface(labels, {100, 0, 0});
    CHECK(n_open_edges(skin) == 0);
    REQUIRE(skin.triangles.size() > 500);
    // The distance is linear along an edge of h = 2 mm but for its curvature, h²/(8 r).
    for (const Vector3d& vertex : skin.vertices)
      REQUIRE(std::abs((vertex - ball_centre).norm() - ball_radius) < 4 / (8 * ball_radius));
  }
  SECTION("of fewer triangles") {
    const TriangleMesh skin = label_surface(labels, {100, 0, 300});
    CHECK(skin.triangles.size() <= 300);
    CHECK(skin.triangles.size() > 200);
  }
  SECTION("of a crop: closed at its sides, which are half a voxel away at most") {
    labels.crop = {Vector3d(0, 0, 0), Vector3d(11, 24, 22)};
    labels.edge = 1;
    const TriangleMesh half = label_surface(labels, {100, 0, 0});
    CHECK(n_open_edges(half) == 0);
    double furthest = 0;
    for (const Vector3d& vertex : half.vertices) furthest = std::max(furthest, vertex.x());
    CHECK(furthest <= 11);
    CHECK(furthest > 10.5);
  }
  SECTION("at an intensity that nothing has") {
    CHECK_THROWS_WITH(label_surface(labels, {5000, 0, 0}), Catch::Contains("no surface at intensity 5000"));
  }
}

TEST_CASE("intensities far from the body are turned below the level, others stay") {
  const Volume volume = ball_and_plate();
  LabelGrid grid = label_cells(volume, largest_piece(2));
  keep_piece(grid, largest_piece(2));
  const Picture picture = picture_about(volume, grid, 2, 100);
  REQUIRE(picture.values.size() == volume.intensities.size());
  CHECK(picture.origin == Vector3d(0.5, 1, 0.5));
  for (std::size_t v = 0; v < picture.values.size(); ++v) {
    const bool is_plate = v % 30 >= 27;
    REQUIRE(picture.values[v] == (is_plate ? 0 : volume.intensities[v]));
  }
}

TEST_CASE("a case's surface at an intensity is made with its body, and its keys are refused elsewhere") {
  const TemporaryFolder folder;
  folder.write("ball.nii", pictures::nifti_of(ball_and_plate()));
  const std::string box = "shape = 'box'\nsize = [10.0, 10.0, 10]\ncells = [10, 10, 10]\n",
                    labels = "shape = 'labels'\nfile = 'ball.nii'\nedge = 2\nkeep = 'largest'\n"
                             "[[body.classes]]\nname = 'tissue'\nlower = 100\nupper = 1000\n";
  const std::string boundary =
      "[material]\nmodel = 'linear_elastic'\nyoungs_modulus = 1\npoissons_ratio = 0.3\n"
      "[[fixed]]\nregion = 'z-'\n"
      "[[moved]]\nregion = 'z+'\ndisplacement = [0, 0, 1]\n";
  const auto scene = [&](const std::string& body, const std::string& surface) {
    return make_scene(read_case(folder.write("case.toml", "schema = 1\nname = 'ball'\n[body]\n" + body +
                                                              boundary + "[surface]\n" + surface)));
  };
  CHECK(scene(labels, "intensity = 100\ntriangles = 400\nsmoothing = 5\n").surface.triangles.size() <= 400);
  for (const auto& [body, surface, says] : std::vector<std::array<std::string, 3>>{
           {labels, "intensity = 100\nfile = 'a.stl'\n", "surface.file"},
           {labels, "intensity = 100\ntriangles = 9\n", "surface.triangles"},
           {labels, "intensity = 100\nsmoothing = -1\n", "surface.smoothing"},
           {labels, "intensity = 'skin'\n", "surface.intensity"},
           {labels, "intensity = 5000\n", "no surface at intensity 5000"},
           {labels, "smoothing = 3\n", "surface.smoothing"},
           {box, "intensity = 100\n", "with shape = \"labels\" alone"}}) {
    CAPTURE(surface);
    CHECK_THROWS_WITH(scene(body, surface), Catch::Contains("case.toml:") && Catch::Contains(says));
  }
}
