// The body beyond a plane of symmetry is not modelled: what a region, a load or a mass means there. Looked at
// for the same, faces on the plane that count as surface: patches of loads, supports, motions, masses and
// statistics, skins, surfaces from files, and pulls that are replayed.

#include "cases/case/error.hpp"
#include "cases/scene/loads.hpp"
#include "cases/scene/regions.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace springproof;

using namespace cases;
using Eigen::Vector3d;

namespace {

Fixed at_plane(const std::string& face) {
  Fixed plane;
  plane.region.name = face;
  plane.components = {face[0] == 'x', face[0] == 'y', face[0] == 'z'};
  return plane;
}

Region patch(const Vector3d& centre, double radius) {
  Region region;
  region.near = centre;
  region.radius = radius;
  region.name = "patch";
  return region;
}

/// A block of 10 x 10 x 10 mm on the ground, or half of it, under a traction about the middle of its top.
Case block(bool is_half) {
  Case definition;
  definition.body = Box{{is_half ? 5. : 10., 10, 10}, {is_half ? 5 : 10, 10, 10}};
  definition.material = LinearElastic{0.05, 0.3};
  definition.material_dynamics.density = 1000;
  definition.fixed = {Fixed{}};
  definition.fixed.front().region.name = "z-";
  if (is_half) definition.symmetry = {at_plane("x-")};
  definition.loads = {{patch({is_half ? 0. : 5., 5, 10}, 3), loads::Traction{{0, 0, -0.004}}}};
  return definition;
}

double force_of(const Case& definition) {
  double sum = 0;
  for (const auto& [node, force] : loaded_nodes(make_scene(definition))) sum += force.z();
  return sum;
}

} // namespace

TEST_CASE("half a body has half of the patch, on its surface alone", "[verification]") {
  CHECK(force_of(block(true)) == Approx(force_of(block(false)) / 2).epsilon(1e-12));
  const Scene half = make_scene(block(true));
  for (const auto& face : half.mesh.groups.at("patch").faces) CHECK(centre_of(half.mesh, face).z() == 10);
  const Scene fine = refine(half, 1);
  for (const auto& face : fine.loads.front().selection.faces) CHECK(centre_of(fine.mesh, face).z() == 10);
}

TEST_CASE("patches of supports, motions, masses and statistics see no faces on planes of symmetry") {
  Case definition = block(true);
  Fixed held;
  held.region = patch({0, 5, 0}, 3);
  held.region.name = "held";
  definition.fixed = {held};
  Moved moved;
  moved.region = patch({0, 5, 10}, 2);
  moved.region.name = "moved";
  moved.components = {false, false, true};
  moved.displacement = {0, 0, -1};
  definition.moved = {moved};
  AddedMass mass{patch({0, 0, 5}, 2), 1};
  mass.region.name = "mass";
  definition.masses = {mass};
  const Scene scene = make_scene(definition);
  for (const char* name : {"patch", "held", "moved", "mass"}) {
    INFO(name);
    CHECK_FALSE(scene.mesh.groups.at(name).faces.empty());
    for (const auto& face : scene.mesh.groups.at(name).faces) CHECK(centre_of(scene.mesh, face).x() > 0);
  }
}

TEST_CASE("the surface is open where the body goes on beyond a plane of symmetry") {
  const Scene scene = make_scene(block(true));
  CHECK(surface_faces(scene.mesh, scene.definition.symmetry).size() == 2 * 50 + 2 * 50 + 100);
}

TEST_CASE("two and three planes leave a quarter and an eighth of a node", "[verification]") {
  Case definition = block(true);
  definition.symmetry = {at_plane("x-"), at_plane("y-"), at_plane("z-")};
  definition.fixed.clear();
  const Scene scene = make_scene(definition);
  const auto share = modelled_share(scene);
  for (std::size_t n = 0; n < scene.mesh.nodes.size(); ++n) {
    const Vector3d at = scene.mesh.nodes[n];
    CHECK(share(static_cast<int>(n)) ==
          (at.x() == 0 ? 0.5 : 1) * (at.y() == 0 ? 0.5 : 1) * (at.z() == 0 ? 0.5 : 1));
  }
}

TEST_CASE("points of one mass are half as heavy on a plane of symmetry", "[verification]") {
  const Scene half = make_scene(block(true)), whole = make_scene(block(false));
  const auto of_half = point_masses(half, PointMass::uniform),
             of_whole = point_masses(whole, PointMass::uniform);
  for (std::size_t n = 0; n < of_half.size(); ++n)
    CHECK(of_half[n] == Approx(of_whole[0] * (half.mesh.nodes[n].x() == 0 ? 0.5 : 1)).epsilon(1e-12));
}

TEST_CASE("a load on nodes that are held in its direction is refused, for nothing would move") {
  Case definition = block(false);
  definition.loads.front().region = definition.fixed.front().region;
  CHECK_THROWS_WITH(make_scene(definition), Catch::Contains("held in the direction of its force"));
  definition.fixed.front().components = {false, false, true}; // the traction is along z
  CHECK_THROWS_AS(make_scene(definition), InputError);
  definition.loads.front().kind = loads::Traction{{0.004, 0, 0}};
  CHECK_NOTHROW(make_scene(definition));
}

TEST_CASE("the area of a patch of stairs is told beside the circle's") {
  Case definition = block(false);
  definition.loads.front().region.radius = 4; // 52 faces of 1 mm2, where the circle has 50.3
  CHECK(warnings_of_loads(make_scene(definition)).empty());
  definition.loads.front().region.radius = 0.8; // four faces about a node, their centres 0.71 mm away
  const auto warnings = warnings_of_loads(make_scene(definition));
  REQUIRE(warnings.size() == 1);
  CHECK_THAT(warnings[0], Catch::Contains("load[0] acts on faces of 4 mm2") &&
                              Catch::Contains("2.01062 mm2 (+99 %)") && !Catch::Contains("finer mesh"));
}
