#include "cases/scene/loads.hpp"
#include "cases/scene/regions.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <limits>

using namespace springproof;

using namespace cases;
using Eigen::Vector3d;

namespace {

constexpr double force_rounding = 1e-13;

Case box(const Vector3d& size, const std::array<int, 3>& cells) {
  Case definition;
  definition.body = Box{size, cells};
  definition.fixed.push_back({{"z-"}, {true, true, true}});
  return definition;
}

Vector3d sum(const std::vector<Vector3d>& forces) {
  Vector3d total = Vector3d::Zero();
  for (const Vector3d& force : forces) total += force;
  return total;
}

Vector3d moment(const Scene& scene, const std::vector<Vector3d>& forces, const Vector3d& about) {
  Vector3d total = Vector3d::Zero();
  for (std::size_t n = 0; n < forces.size(); ++n) total += (scene.mesh.nodes[n] - about).cross(forces[n]);
  return total;
}

} // namespace

TEST_CASE("regions of a box, found from numbers, are those that a search of its nodes and cells finds") {
  for (const std::array<int, 3>& cells :
       {std::array<int, 3>{3, 4, 5}, std::array<int, 3>{1, 1, 2}, std::array<int, 3>{2, 1, 1}}) {
    const Mesh ruled = make_box_mesh({3, 4, 0.5}, cells);
    Mesh stored = ruled;
    stored.nodes.stored();
    stored.cells.stored();
    for (const char* name : {"x-", "y+", "z+", "z- x+", "x+ y- z-", "y- y-"}) {
      const Selection found = select(ruled, {name}), searched = select(stored, {name});
      INFO(name);
      CHECK(found.nodes == searched.nodes);
      CHECK(found.edges == searched.edges);
      CHECK(found.faces == searched.faces);
    }
    CHECK_THROWS_AS(select(ruled, {"x- x+"}), InputError);
    CHECK_THROWS_AS(select(stored, {"x- x+"}), InputError);
    for (const Vector3d& node : ruled.nodes) {
      Region near;
      near.near = node + Vector3d(4e-7, -4e-7, 4e-7);
      CHECK(select_node(ruled, near) == select_node(stored, near));
      near.near = node + Vector3d(0.1, 0, -100); // refused, with the same distance
      const auto refusal = [&](const Mesh& mesh) -> std::string {
        try {
          select_node(mesh, near);
        } catch (const InputError& error) {
          return error.what();
        }
        return "";
      };
      CHECK(refusal(ruled).find("the nearest is") != std::string::npos);
      CHECK(refusal(ruled) == refusal(stored));
    }
  }
}

TEST_CASE("faces, edges and vertices of a box are selected with their nodes, edges and faces") {
  const Mesh mesh = make_box_mesh({2, 3, 4}, {2, 3, 4});
  const Selection face = select(mesh, {"z+"});
  CHECK(face.nodes.size() == 12);
  CHECK(face.faces.size() == 6);
  CHECK(face.edges.size() == 17);
  const Selection edge = select(mesh, {"z+ y-"});
  CHECK(edge.nodes.size() == 3);
  CHECK(edge.edges.size() == 2);
  CHECK(edge.faces.empty());
  CHECK(mesh.nodes[static_cast<std::size_t>(select_node(mesh, {"z+ x- y+"}))] == Vector3d(0, 3, 4));
  CHECK_THROWS_AS(select_node(mesh, {"z+ y-"}), InputError);
  CHECK_THROWS_AS(select(mesh, {"top"}), InputError);
}

TEST_CASE("near names a node, and does not search for one") {
  const Mesh mesh = make_box_mesh({2, 2, 2}, {2, 2, 2});
  Region point;
  point.near = Vector3d(1, 1, 2 + 0.9e-6);
  CHECK(mesh.nodes[static_cast<std::size_t>(select_node(mesh, point))] == Vector3d(1, 1, 2));
  point.near = Vector3d(1, 1, 2 + 1.1e-6);
  CHECK_THROWS_WITH(select(mesh, point), Catch::Contains("(1, 1, 2)"));
}

TEST_CASE("each kind of load adds up to what it says") {
  Case definition = box({2, 3, 4}, {2, 3, 4});
  const Vector3d value(0.1, -0.2, 0.3);
  SECTION("nodal_force: on every node") {
    definition.loads = {{{"z+"}, loads::NodalForce{value}}};
    CHECK((sum(nodal_forces(make_scene(definition))) - 12 * value).norm() < force_rounding);
  }
  SECTION("total_force: in all") {
    definition.loads = {{{"z+ x-"}, loads::TotalForce{value}}};
    CHECK((sum(nodal_forces(make_scene(definition))) - value).norm() < force_rounding);
  }
  SECTION("traction: times the area, a vertex carrying a quarter of an inner node's part") {
    definition.loads = {{{"z+"}, loads::Traction{value}}};
    const Scene scene = make_scene(definition);
    const auto forces = nodal_forces(scene);
    CHECK((sum(forces) - 6 * value).norm() < force_rounding);
    CHECK((forces[static_cast<std::size_t>(select_node(scene.mesh, {"z+ x- y-"}))] - value / 4).norm() <
          force_rounding);
    CHECK(moment(scene, forces, {1, 1.5, 4}).norm() < force_rounding); // no moment about the face's centre
  }
}

TEST_CASE("a torque gives its moment about its axis and no net force, on any mesh of the face") {
  for (int n : {1, 2, 5}) {
    Case definition = box({2, 3, 4}, {n, n, 1});
    const loads::Torque torque{0.7, Vector3d::UnitZ(), {1, 1.5, 4}};
    definition.loads = {{{"z+"}, torque}};
    const Scene scene = make_scene(definition);
    const auto forces = nodal_forces(scene);
    CHECK(sum(forces).norm() < force_rounding);
    CHECK((moment(scene, forces, {1, 1.5, 0}) - Vector3d(0, 0, 0.7)).norm() < force_rounding);
    CHECK(polar_moment(scene.mesh, scene.loads[0].selection, torque) ==
          Approx(2.0 * 3.0 * (4 + 9) / 12).epsilon(force_rounding));
  }
}

TEST_CASE("a traction needs faces") {
  Case definition = box({1, 1, 1}, {1, 1, 1});
  definition.loads = {{{"z+ x-"}, loads::Traction{{1, 0, 0}}}};
  CHECK_THROWS_AS(make_scene(definition), InputError);
}

TEST_CASE("the quarters of a symmetric scene carry a quarter of its nodal forces") {
  Case whole = box({2, 2, 1}, {2, 2, 1});
  whole.loads = {{{"z+"}, loads::NodalForce{{0, 0, 1}}}};
  Case quarter = box({1, 1, 1}, {1, 1, 1});
  quarter.loads = whole.loads;
  quarter.symmetry = {{{"x+"}, {true, false, false}}, {{"y+"}, {false, true, false}}};
  const Scene scene = make_scene(quarter);
  CHECK(4 * sum(nodal_forces(scene)).z() ==
        Approx(sum(nodal_forces(make_scene(whole))).z()).epsilon(force_rounding));
  const auto is_constrained = constrained_dofs(scene);
  const auto corner = static_cast<std::size_t>(select_node(scene.mesh, {"x+ y+ z+"}));
  CHECK(is_constrained[3 * corner]);
  CHECK(is_constrained[3 * corner + 1]);
  CHECK_FALSE(is_constrained[3 * corner + 2]);
}

TEST_CASE(
    "refinement leaves nodal forces on the body's own nodes and shares a total force among the new ones") {
  Case definition = box({1, 1, 4}, {1, 1, 4});
  definition.loads = {{{"z+"}, loads::NodalForce{{0, 0, 1}}}, {{"z+ x-"}, loads::TotalForce{{1, 0, 0}}}};
  const Scene fine = refine(make_scene(definition), 2);
  const auto forces = on_all_nodes(nodes_with_point_forces(fine), fine.mesh.nodes.size());
  int n_pulled = 0, n_pushed = 0;
  for (const Vector3d& force : forces) {
    n_pulled += force.z() != 0;
    n_pushed += force.x() != 0;
  }
  CHECK(n_pulled == 4);
  CHECK(n_pushed == 5);
  CHECK((sum(forces) - Vector3d(1, 0, 4)).norm() < force_rounding);
}

TEST_CASE("a patch has the faces of the surface around its point, and a finer mesh has the same patch") {
  Case definition = box({10, 10, 10}, {10, 10, 10});
  Load press{{"patch"}, loads::Traction{{0, 0, -1}}};
  press.region.near = Vector3d(5, 5, 10);
  press.region.radius = 2;
  definition.loads.push_back(press);
  const Scene scene = make_scene(definition);
  // Centres at (0.5, 0.5), (0.5, 1.5) and (1.5, 0.5) from the point in each quarter; (1.5, 1.5) is 2.12 away.
  REQUIRE(scene.loads.size() == 1);
  CHECK(scene.loads[0].selection.faces.size() == 12);
  CHECK(scene.loads[0].selection.nodes.size() == 21);
  CHECK((sum(nodal_forces(scene)) - Vector3d(0, 0, -12)).norm() <= force_rounding);
  const Scene fine = refine(scene, 1);
  CHECK(fine.loads[0].selection.faces.size() == 48);
  CHECK((sum(nodal_forces(fine)) - Vector3d(0, 0, -12)).norm() <= force_rounding);

  definition.loads[0].region.near = Vector3d(5, 5, 5);
  CHECK_THROWS_AS(make_scene(definition), InputError); // nothing of the surface there
  definition.loads[0].region.near = Vector3d(0, 0, 10);
  definition.loads[0].region.radius = 0.8;
  CHECK(make_scene(definition).loads[0].selection.faces.size() == 3); // round the corner
}

TEST_CASE("a part of the body has the nodes in its box, on and beyond its plane") {
  const Mesh mesh = make_box_mesh({0.3, 0.3, 0.6}, {3, 3, 6});
  const double infinity = std::numeric_limits<double>::infinity();
  const auto selected = [&](const Part& part) {
    Region inside = {"part"};
    inside.part = part;
    return select(mesh, inside);
  };
  Part part{"", {-infinity, -infinity, 0.3}, {0.1, infinity, infinity}};
  CHECK(selected(part).nodes.size() == 2 * 4 * 4); // x = 0 and 0.1, z = 0.3 to 0.6, despite rounding
  CHECK(selected(part).edges.size() == 16 + 2 * 3 * 4 + 2 * 4 * 3);
  part.point = Vector3d(0, 0, 0.4);
  part.normal = Vector3d(0, 0, -1);
  CHECK(selected(part).nodes.size() == 2 * 4 * 2);
  part.point = Vector3d(0, 0, 0.2);
  CHECK_THROWS_WITH(selected(part), Catch::Contains("'part' selects no node"));
}

TEST_CASE("a class of cells has the nodes of its cells, on finer meshes too") {
  Mesh mesh = make_box_mesh({2, 2, 4}, {2, 2, 4});
  mesh.group_of_cell.assign(16, "fat");
  for (std::size_t c = 0; c < 8; ++c) mesh.group_of_cell[c] = "bone"; // z from 0 to 2
  Region bone = {"bone"};
  const double infinity = std::numeric_limits<double>::infinity();
  bone.part = Part{"bone", Vector3d::Constant(-infinity), Vector3d::Constant(infinity)};
  CHECK(select(mesh, bone).nodes.size() == 3 * 3 * 3);
  CHECK(select(refine(mesh), bone).nodes.size() == 5 * 5 * 5);
  CHECK(select(refine(mesh), bone).faces.size() == 3 * 5 * 4 * 4); // its cells' faces, each once
  bone.part->point = Vector3d(0, 0, 1.2);
  bone.part->normal = Vector3d::UnitZ();
  CHECK(select(mesh, bone).nodes.size() == 3 * 3);
  CHECK(select(refine(mesh), bone).nodes.size() == 2 * 5 * 5); // 1.5 is one of its planes
  bone.part->cell_class = "skin";
  CHECK_THROWS_AS(select(mesh, bone), InputError);
}

TEST_CASE("a cell is of the last material whose region has its centre, and its children are too") {
  Case definition = box({2, 1, 4}, {2, 1, 4});
  definition.material = LinearElastic{1, 0.3};
  const double infinity = std::numeric_limits<double>::infinity();
  RegionMaterial layer{
      LinearElastic{2, 0.3}, "", {-infinity, -infinity, 2}, {infinity, infinity, infinity}, {}};
  RegionMaterial corner{LinearElastic{3, 0.3}, "", {0, 0, 3}, {1, 1, 4}, {}};
  definition.region_materials = {layer, corner};
  const Scene scene = make_scene(definition);
  CHECK(scene.material_of_cell == std::vector<int>{0, 0, 0, 0, 1, 1, 2, 1});
  const Scene fine = refine(scene, 1);
  REQUIRE(fine.material_of_cell.size() == 64);
  for (std::size_t c = 0; c < 64; ++c) CHECK(material_of(fine, c) == material_of(scene, c / 8));
  CHECK(std::get<LinearElastic>(materials_of(definition)[2]).youngs_modulus == 3);

  corner.lower.z() = 3.6; // above every centre
  definition.region_materials = {corner};
  CHECK_THROWS_WITH(make_scene(definition), Catch::Contains("no cell has its centre in the box"));
  corner.group = "skin";
  definition.region_materials = {corner};
  CHECK_THROWS_WITH(make_scene(definition), Catch::Contains("'skin' is no group of cells"));
}

TEST_CASE("a load or a motion that double precision cannot tell from none is refused") {
  Case loaded = box({2, 2, 2}, {2, 2, 2});
  for (loads::Kind kind :
       {loads::Kind(loads::Traction{{0, 0, 1}}), loads::Kind(loads::NodalForce{{0, 0, 1}})}) {
    loaded.loads = {{{"z+"}, kind}, {{"x+"}, kind}};
    loaded.loads[0].scale(1e-300);
    loaded.loads[1].scale(1e-12);
    Case near_nothing = loaded;
    near_nothing.loads.pop_back();
    CHECK_THROWS_WITH(make_scene(near_nothing), Catch::Contains("the largest force on a node"));
    CHECK_NOTHROW(make_scene(loaded));
  }
  Case moved = box({2, 2, 2}, {2, 2, 2});
  moved.moved.resize(1);
  moved.moved[0].region = {"z+"};
  moved.moved[0].displacement = {0, 0, 1e-13};
  CHECK_THROWS_WITH(make_scene(moved), Catch::Contains("moves by 1e-13 mm"));
  moved.moved[0].displacement = {0, 0, -1e-8};
  CHECK_NOTHROW(make_scene(moved));
  moved.moved[0].displacement.setZero();
  moved.moved[0].angle = 1e-12;
  CHECK_THROWS_AS(make_scene(moved), InputError);
  moved.moved[0].angle = 360;
  CHECK_NOTHROW(make_scene(moved));
}

TEST_CASE("the area of a region is that of its faces, and nodes and edges have none") {
  const Mesh mesh = make_box_mesh({2, 3, 4}, {2, 3, 4});
  CHECK(area(mesh, select(mesh, {"z+"})) == Approx(6).epsilon(1e-14));
  CHECK(area(mesh, select(mesh, {"x-"})) == Approx(12).epsilon(1e-14));
  CHECK(area(mesh, select(mesh, {"z+ x-"})) == 0);
  Region patch;
  patch.name = "patch";
  patch.near = Vector3d(0.5, 0.5, 4);
  patch.radius = 1.01; // this face's centre, and those of two neighbours
  CHECK(area(mesh, select_patch(mesh, boundary_faces(mesh), patch)) ==
        Approx(5).epsilon(1e-14)); // two more around the edges
}

TEST_CASE("a reaction is measured where something is held, stress and strain inside the body") {
  Case definition = box({2, 2, 2}, {2, 2, 2});
  definition.fixed.front().components = {true, false, true};
  definition.moved.push_back({{"z+"}, {false, false, true}, Vector3d(0, 0, -0.1)});
  const auto with = [&](const std::string& where, Component component) {
    definition.measures = {{"force", measures::Reaction{{where}, component}}};
    return make_scene(definition);
  };
  CHECK_NOTHROW(with("z-", Component::norm));
  CHECK_NOTHROW(with("z+", Component::z));
  CHECK_NOTHROW(with("x+", Component::z)); // whose edges are held
  CHECK_THROWS_WITH(with("z-", Component::y), Catch::Contains("in component y"));
  CHECK_THROWS_WITH(with("z+", Component::x), Catch::Contains("in component x"));
  definition.moved.clear();
  CHECK_THROWS_WITH(with("z+", Component::norm), Catch::Contains("no node that is fixed or moved"));
  definition.measures = {{"stress", measures::Stress{{TensorComponent::xx, {1, 1, 2.1}}}}};
  CHECK_THROWS_WITH(make_scene(definition), Catch::Contains("[1, 1, 2.1]"));
  definition.measures = {{"stress", measures::Stress{{TensorComponent::xx, {1, 1, 2}}}}};
  CHECK_NOTHROW(make_scene(definition));
  definition.msm.design = Design::network; // whose springs belong to no cell
  CHECK_THROWS_WITH(make_scene(definition), Catch::Contains("design = \"network\""));
  definition.measures = {{"strain", measures::Strain{{TensorComponent::xx, {1, 1, 2}}}}};
  CHECK_NOTHROW(make_scene(definition));
}
