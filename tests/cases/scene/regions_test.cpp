#include "cases/scene/regions.hpp"

#include "cases/scene/loads.hpp"
#include "tests/support/temporary_folder.hpp"

#include <catch2/catch.hpp>

using namespace springproof;

using namespace cases;
using Catch::Contains;
using Eigen::Vector3d;

namespace {

/// Two cubes of tetrahedra, 2 x 1 x 1 mm, held at x = 0.
Case block_of_tetrahedra() {
  Case definition;
  definition.body =
      MeshFile{{std::string(SPRINGPROOF_SOURCE_DIR) + "/tests/cases/mesh/files/gmsh_41_text.msh", {}}};
  definition.fixed.push_back({{"left"}, {true, true, true}});
  return definition;
}

Region nearest_to(const Vector3d& point, double tolerance) {
  Region region{"", point, {"case.toml", 9, 1, "load[0].nearest"}};
  region.tolerance = tolerance;
  return region;
}

Region on_plane(const Vector3d& point, const Vector3d& normal, double tolerance) {
  Region region{"plane", std::nullopt, {}};
  region.plane = Plane{point, normal, tolerance};
  return region;
}

Region in_cell(const Vector3d& point) {
  Region region{"", point, {"case.toml", 9, 1, "measure[0].at"}};
  region.is_in_cell = true;
  return region;
}

Vector3d sum_of_forces(const Scene& scene) {
  Vector3d sum = Vector3d::Zero();
  for (const Vector3d& force : nodal_forces(scene)) sum += force;
  return sum;
}

double area_of(const Mesh& mesh, const Selection& selection) {
  const TriangleMesh faces = triangles_of_faces(mesh, selection.faces);
  double area = 0;
  for (const auto& triangle : faces.triangles) area += doubled_area(triangle, faces.vertices).norm() / 2;
  return area;
}

} // namespace

TEST_CASE("the node nearest to a point is found within its tolerance, and a warning has its distance") {
  Case definition = block_of_tetrahedra();
  definition.loads.push_back({nearest_to({2.1, 1, 1}, 0.2), loads::NodalForce{{1, 0, 0}}});
  const Scene scene = make_scene(definition);
  REQUIRE(scene.loads[0].selection.nodes.size() == 1);
  CHECK(scene.mesh.nodes[index(scene.loads[0].selection.nodes[0])] == Vector3d(2, 1, 1));
  CHECK_THAT(scene.remarks.back(),
             Contains("load[0].nearest: the node nearest to (2.1, 1, 1) is 0.1 mm away at (2, 1, 1)"));
  // A finer mesh may have a nearer node, and keeps this one.
  definition.loads[0].region = nearest_to({1.6, 1, 1}, 0.6);
  const Scene coarse = make_scene(definition), fine = refine(coarse, 1);
  CHECK(fine.mesh.nodes[index(fine.loads[0].selection.nodes[0])] ==
        coarse.mesh.nodes[index(coarse.loads[0].selection.nodes[0])]);
  definition.loads[0].region = nearest_to({2.1, 1, 1}, 0.05);
  CHECK_THROWS_WITH(make_scene(definition),
                    Contains("case.toml:9:1: load[0].nearest: no node within 0.05 mm of (2.1, 1, 1)") &&
                        Contains("0.1 mm away"));
}

TEST_CASE(
    "patches around a point and on a plane have triangles of the surface, on finer meshes the same ones") {
  Case definition = block_of_tetrahedra();
  definition.loads.push_back({on_plane({2, 9, 9}, {1, 0, 0}, 0.01), loads::Traction{{3, 0, 0}}});
  Scene scene = make_scene(definition);
  CHECK(scene.loads[0].selection.faces.size() == 4);
  CHECK(area_of(scene.mesh, scene.loads[0].selection) == Approx(1));
  CHECK((sum_of_forces(scene) - Vector3d(3, 0, 0)).norm() <= 1e-12); // rounding
  const Scene fine = refine(scene, 1);
  CHECK(fine.loads[0].selection.faces.size() == 16);
  CHECK((sum_of_forces(fine) - Vector3d(3, 0, 0)).norm() <= 1e-12);
  Region patch{"patch", Vector3d(2, 0.5, 0.5)};
  patch.radius = 0.4; // centres of the face's four triangles are 1/3 mm from its middle
  definition.loads[0].region = patch;
  scene = make_scene(definition);
  CHECK(scene.loads[0].selection.faces.size() == 4);
  CHECK((sum_of_forces(refine(scene, 1)) - Vector3d(3, 0, 0)).norm() <= 1e-12);
  definition.loads[0].region = on_plane({1.5, 0, 0}, {1, 0, 0}, 0.01); // inside of the body
  CHECK_THROWS_WITH(make_scene(definition),
                    Contains("has no face of the body's surface: the body reaches from -1.5 to 0.5 mm"));
  patch.radius = 0.1;
  definition.loads[0].region = patch;
  CHECK_THROWS_WITH(make_scene(definition), Contains("the node nearest to the point is"));
}

TEST_CASE(
    "a point in a cell moves with it: a linear displacement is reproduced, and points outside are refused") {
  for (const bool are_tetrahedra : {true, false}) {
    const Mesh mesh =
        are_tetrahedra ? make_scene(block_of_tetrahedra()).mesh : make_box_mesh({2, 1, 1}, {3, 2, 2});
    for (const Vector3d& point : {Vector3d(0.7, 0.3, 0.9), Vector3d(1, 0.5, 0.5), Vector3d(2, 1, 1)}) {
      double sum = 0;
      Vector3d at = Vector3d::Zero();
      for (const auto& [node, weight] : weights_at(mesh, in_cell(point))) {
        sum += weight;
        at += weight * mesh.nodes[index(node)];
      }
      CHECK(sum == Approx(1).epsilon(1e-12));
      CHECK((at - point).norm() <= 1e-8); // Newton's method inverts the cell's map to 1e-9 of its edge
    }
    CHECK_THROWS_WITH(
        weights_at(mesh, in_cell({2.5, 1, 1})),
        Contains("case.toml:9:1: measure[0].at: is [2.5, 1, 1], must be a point of the body at rest") &&
            Contains("0.5 mm away at (2, 1, 1)"));
  }
}
