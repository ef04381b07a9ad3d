#include "cases/mesh/read_mesh.hpp"

#include "cases/scene/loads.hpp"
#include "tests/support/temporary_folder.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <unistd.h>

using namespace springproof;

using namespace cases;
namespace fs = std::filesystem;

namespace {

Mesh read_text_as_mesh(const std::string& name, const std::string& text) {
  const TemporaryFolder folder;
  return read_mesh({folder.write(name, text), {"case.toml", 6, 8, "body.file"}});
}

Mesh read_thesis_mesh(const std::string& name) {
  return read_mesh({std::string(SPRINGPROOF_SOURCE_DIR) + "/cases/thesis/geo/" + name, {}});
}

using Points = std::vector<std::array<double, 3>>;

const Points gmsh_cube{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                       {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};

/// A .msh of one volume whose cells are of one gmsh type; node tags 1, 2, ... and cell tags 101, 102, ...
std::string msh(const Points& points, int type, const std::vector<std::vector<int>>& cells) {
  std::string text =
      "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n0 0 0 1\n1 0 0 0 9 9 9 0 0\n$EndEntities\n";
  text += fmt::format("$Nodes\n1 {0} 1 {0}\n3 1 0 {0}\n", points.size());
  for (std::size_t n = 1; n <= points.size(); ++n) text += fmt::format("{}\n", n);
  for (const auto& p : points) text += fmt::format("{} {} {}\n", p[0], p[1], p[2]);
  text += fmt::format("$EndNodes\n$Elements\n1 {0} 101 {1}\n3 1 {2} {0}\n", cells.size(), 100 + cells.size(),
                      type);
  for (std::size_t c = 0; c < cells.size(); ++c) {
    text += std::to_string(101 + c);
    for (const int node : cells[c]) text += " " + std::to_string(node);
    text += "\n";
  }
  return text + "$EndElements\n";
}

Points shifted(Points points, double by) {
  for (auto& p : points) p[0] += by;
  return points;
}

template<class T>
std::vector<T> operator+(std::vector<T> a, const std::vector<T>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// The nodes of one mesh as numbers of the other's, found by where they lie; every node has its own partner.
std::vector<int> matching_nodes(const Mesh& mesh, const Mesh& other) {
  std::vector<int> partner;
  for (const auto& node : mesh.nodes) {
    int found = -1;
    for (std::size_t n = 0; n < other.nodes.size(); ++n)
      // gmsh finds the points that divide a line by numerical integration: 2e-11 off on 16 mm
      if ((other.nodes[n] - node).norm() < 1e-10) found = static_cast<int>(n);
    partner.push_back(found);
  }
  return partner;
}

/// Same nodes, same cells, whatever their order.
void check_same_mesh(const Mesh& mesh, const Mesh& box) {
  REQUIRE(mesh.nodes.size() == box.nodes.size());
  REQUIRE(mesh.cells.size() == box.cells.size());
  const std::vector<int> partner = matching_nodes(mesh, box);
  CHECK(std::set<int>(partner.begin(), partner.end()).size() == box.nodes.size());
  CHECK(std::count(partner.begin(), partner.end(), -1) == 0);
  std::set<std::set<int>> cells, box_cells;
  for (const auto& cell : box.cells) box_cells.insert({cell.begin(), cell.end()});
  for (const auto& cell : mesh.cells) {
    std::set<int> nodes;
    for (const int node : cell) nodes.insert(partner[static_cast<std::size_t>(node)]);
    cells.insert(nodes);
  }
  CHECK(cells == box_cells);
}

void check_same_selection(const Mesh& mesh, const std::string& group, const Mesh& box,
                          const std::string& faces) {
  INFO(group);
  const std::vector<int> partner = matching_nodes(mesh, box);
  const auto to_box = [&](int node) { return partner[static_cast<std::size_t>(node)]; };
  const Selection selected = select(mesh, {group, std::nullopt, {}});
  const Selection expected = select(box, {faces, std::nullopt, {}});
  std::set<int> nodes;
  for (const int node : selected.nodes) nodes.insert(to_box(node));
  CHECK(nodes == std::set<int>(expected.nodes.begin(), expected.nodes.end()));
  std::set<std::set<int>> edges, expected_edges;
  for (const auto& e : selected.edges) edges.insert({to_box(e[0]), to_box(e[1])});
  for (const auto& e : expected.edges) expected_edges.insert({e[0], e[1]});
  CHECK(edges == expected_edges);
  CHECK(edges.size() == selected.edges.size());
  // A face may begin at any of its vertices, but goes around them in the same sense.
  const auto canonical = [](FaceNodes face) {
    std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
    return face;
  };
  std::set<FaceNodes> around, expected_around;
  for (const auto& f : selected.faces)
    around.insert(canonical({to_box(f[0]), to_box(f[1]), to_box(f[2]), to_box(f[3])}));
  for (const auto& f : expected.faces) expected_around.insert(canonical(f));
  CHECK(around == expected_around);
}

void check_refused(const std::string& name, const std::string& text, const std::string& reason) {
  INFO(reason);
  CHECK_THROWS_AS(read_text_as_mesh(name, text), InputError);
  CHECK_THROWS_WITH(read_text_as_mesh(name, text),
                    Catch::StartsWith("case.toml:6:8: body.file: ") && Catch::Contains(reason));
}

} // namespace

TEST_CASE("the vertices of a hexahedron of gmsh are put where ours belong") {
  const Mesh mesh = read_text_as_mesh("one.msh", msh(gmsh_cube, 5, {{1, 2, 3, 4, 5, 6, 7, 8}}));
  REQUIRE(mesh.cells.size() == 1);
  for (int v = 0; v < 8; ++v) {
    const int node = mesh.cells[0][static_cast<std::size_t>(v)];
    CHECK(mesh.nodes[static_cast<std::size_t>(node)] == Eigen::Vector3d(v & 1, (v >> 1) & 1, v >> 2));
  }
  CHECK(mesh.groups.empty());
  CHECK(mesh.group_of_cell.empty());
}

TEST_CASE("the thesis's cube, drawn and extruded, is the box of the same cells", "[verification]") {
  const Mesh mesh = read_thesis_mesh("cube.geo");
  const Mesh box = make_box_mesh({10, 10, 10}, {10, 10, 10});
  check_same_mesh(mesh, box);
  check_same_selection(mesh, "bottom", box, "z-");
  check_same_selection(mesh, "top", box, "z+");
  check_same_selection(mesh, "top edge y = 0", box, "z+ y-");
  check_same_selection(mesh, "top edge x = 10", box, "z+ x+");
  check_same_selection(mesh, "top vertex", box, "z+ x- y-");
  check_same_selection(mesh, "x- y+", box, "x- y+"); // faces of the bounding box are regions of a mesh too
  CHECK(mesh.group_of_cell == std::vector<std::string>(1000, "tissue"));
  CHECK(mesh.groups.at("tissue").nodes.size() == 1331);
}

TEST_CASE("the thesis's bar, drawn and divided by transfinite interpolation, is the box of the same cells",
          "[verification]") {
  const Mesh mesh = read_thesis_mesh("bar.geo");
  const Mesh box = make_box_mesh({4, 4, 16}, {4, 4, 16});
  check_same_mesh(mesh, box);
  REQUIRE(mesh.grid.has_value());
  CHECK(mesh.grid->cells == std::array<int, 3>{4, 4, 16});
  check_same_selection(mesh, "clamped end", box, "z-");
  check_same_selection(mesh, "free end", box, "z+");
  check_same_selection(mesh, "bottom edge", box, "z+ x-");
  check_same_selection(mesh, "bottom vertex", box, "x- y- z+");
}

TEST_CASE("a case on a drawn mesh has the loads of the case on the box", "[verification]") {
  Case definition;
  definition.body = MeshFile{std::string(SPRINGPROOF_SOURCE_DIR) + "/cases/thesis/geo/bar.geo", {}};
  definition.fixed.push_back({{"clamped end", std::nullopt, {}}, {true, true, true}});
  definition.loads.push_back({{"free end", std::nullopt, {}}, loads::Traction{{0, 0.1, 0.3}}});
  const Scene drawn = make_scene(definition);
  definition.body = Box{{4, 4, 16}, {4, 4, 16}};
  definition.fixed[0].region.name = "z-";
  definition.loads[0].region.name = "z+";
  const Scene box = make_scene(definition);
  const std::vector<int> partner = matching_nodes(drawn.mesh, box.mesh);
  const auto forces = nodal_forces(drawn), box_forces = nodal_forces(box);
  for (std::size_t n = 0; n < partner.size(); ++n)
    // the mesh is that near (see above), and no force is above 0.4 N
    CHECK((forces[n] - box_forces[static_cast<std::size_t>(partner[n])]).norm() <= 1e-10);
  definition.body = MeshFile{std::string(SPRINGPROOF_SOURCE_DIR) + "/cases/thesis/geo/bar.geo", {}};
  CHECK_THROWS_WITH(make_scene((definition.fixed[0].region.name = "fixed end", definition)),
                    Catch::Contains("'fixed end' names no region") && Catch::Contains("'clamped end'"));
}

TEST_CASE(
    "groups of one name in several dimensions are one region, and a group without a name has its number") {
  const Mesh mesh = read_text_as_mesh("a.geo", R"(
Point(1) = {0, 0, 0};
x[] = Extrude {1, 0, 0} { Point{1}; Layers{2}; };
y[] = Extrude {0, 1, 0} { Line{x[1]}; Layers{1}; Recombine; };
z[] = Extrude {0, 0, 1} { Surface{y[1]}; Layers{1}; Recombine; };
Point(99) = {5, 5, 5};
Physical Surface("held") = {y[1]};
Physical Point("held") = {1};
Physical Volume(7) = {z[1]};
Physical Point("elsewhere") = {99};
)");
  CHECK(mesh.nodes.size() == 12); // the lone point is no part of the body
  CHECK(mesh.groups.at("held").nodes.size() == 6);
  CHECK(mesh.groups.at("held").faces.size() == 2);
  CHECK(mesh.groups.at("7").nodes.size() == 12);
  CHECK(mesh.group_of_cell == std::vector<std::string>{"7", "7"});
  CHECK_THROWS_WITH(select(mesh, {"elsewhere", std::nullopt, {}}),
                    Catch::Contains("'elsewhere' selects no node"));
}

// Other names checked for this defect: classes of a labelled volume (unique, and no face's), faces beside
// groups (a group named "z+" wins), materials' groups (cells alone), and patches (a name of their own).
TEST_CASE(
    "a name of a volume and a surface, or of a curve beside a surface, is no region until its kind is told") {
  const Mesh mesh = read_text_as_mesh("a.geo", R"(
Point(1) = {0, 0, 0};
x[] = Extrude {1, 0, 0} { Point{1}; Layers{2}; };
y[] = Extrude {0, 1, 0} { Line{x[1]}; Layers{1}; Recombine; };
z[] = Extrude {0, 0, 1} { Surface{y[1]}; Layers{1}; Recombine; };
Physical Volume("soft") = {z[1]};
Physical Surface("soft") = {y[1]};
Physical Surface("pulled") = {z[0]};
Physical Curve("pulled") = {x[1]};
)");
  const auto region = [](const std::string& name) { return Region{name, std::nullopt, {}}; };
  CHECK_THROWS_WITH(
      select(mesh, region("soft")),
      Catch::Contains("'soft' is the name of physical groups of several dimensions; must be 'soft "
                      "(surface)' or { class = \"soft\" } for the nodes of the volume"));
  CHECK(select(mesh, region("soft (surface)")).nodes.size() == 6);
  CHECK(select(mesh, region("soft (surface)")).faces.size() == 2);
  Region volume;
  volume.part = Part{"soft", Eigen::Vector3d::Constant(-9), Eigen::Vector3d::Constant(9)};
  CHECK(select(mesh, volume).nodes.size() == 12);
  CHECK(mesh.group_of_cell == std::vector<std::string>{"soft", "soft"}); // a material's group
  CHECK_THROWS_WITH(select(mesh, region("pulled")),
                    Catch::Contains("must be 'pulled (curve)' or 'pulled (surface)', or groups of names"));
  CHECK(select(mesh, region("pulled (curve)")).nodes.size() == 3);
}

TEST_CASE("lengths of a mesh in another unit than mm are scaled") {
  const TemporaryFolder folder;
  const std::string path = folder.write("a.msh", msh(gmsh_cube, 5, {{1, 2, 3, 4, 5, 6, 7, 8}}));
  CHECK(read_mesh({path, {}, 1000}).nodes[6] == Eigen::Vector3d(1000, 1000, 1000));
}

TEST_CASE("a mesh that the models cannot use is refused with the reason") {
  const std::vector<int> one{1, 2, 3, 4, 5, 6, 7, 8}, two{9, 10, 11, 12, 13, 14, 15, 16};
  check_refused("a.msh", msh(gmsh_cube, 6, {{1, 2, 4, 5, 6, 8}}), "has 1 wedge, must have hexahedra alone");
  check_refused("a.msh", msh(gmsh_cube, 5, {{5, 6, 7, 8, 1, 2, 3, 4}}),
                "1 of 1 hexahedra are inverted or degenerate");
  check_refused("a.msh", msh(gmsh_cube, 5, {{5, 6, 7, 8, 1, 2, 3, 4}}), "elements 101");
  check_refused("a.msh", msh(gmsh_cube, 5, {{1, 2, 3, 4, 5, 6, 6, 8}}),
                "1 of 1 hexahedra are inverted or degenerate");
  check_refused("a.msh", msh(gmsh_cube + shifted(gmsh_cube, 1), 5, {one, two}),
                "falls into 2 pieces that share no node");
  check_refused("a.msh", msh(gmsh_cube, 3, {{1, 2, 3, 4}}), "");
  check_refused("a.msh", msh(gmsh_cube, 5, {one, one}), "elements 101 and 102 are one hexahedron");
  Points halves = shifted(gmsh_cube, 1); // a cell beside the first, below one half of its face
  for (auto& p : halves) p[2] /= 2;
  halves.erase(halves.begin() + 3), halves.erase(halves.begin()); // whose nodes 2 and 3 are there
  check_refused("a.msh", msh(gmsh_cube + halves, 5, {one, {2, 9, 10, 3, 11, 12, 13, 14}}),
                " of element 101, and is no vertex of it (2 nodes are like that)");
  check_refused("a.msh", "$MeshFormat\n1 0 8\n$EndMeshFormat\n", "has format 1, must be 2.0 to 2.2");
  check_refused("a.msh", "solid cube\n", "is not a gmsh mesh");
  check_refused("a.msh", "", "is not a gmsh mesh");
  check_refused("a.msh", "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\nnonsense\n", "gmsh: ");
  check_refused("a.geo", "Point(1) = {0, 0, 0};\n", "has no hexahedra");
  const std::string no_cells =
      "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n0 0 1 0\n1 0 0 0 9 9 9 0 0\n$EndEntities\n"
      "$Nodes\n1 4 1 4\n2 1 0 4\n1\n2\n3\n4\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n$EndNodes\n"
      "$Elements\n1 1 1 1\n2 1 3 1\n1 1 2 3 4\n$EndElements\n";
  check_refused("a.msh", no_cells, "physical groups alone, where there are any");
  check_refused("a.msh", no_cells, "Mesh.SaveAll");
  CHECK_THROWS_WITH(read_mesh({"/no/such.msh", {"case.toml", 6, 8, "body.file"}}),
                    "case.toml:6:8: body.file: /no/such.msh: No such file or directory");
  CHECK_THROWS_WITH(read_mesh({"/dev/null", {}}), Catch::Contains("/dev/null: is no regular file"));
  check_refused("a.geo", "Pont(1) = {0, 0, 0};\n", "syntax error");
}

TEST_CASE("a mesh or geometry that may not be read is said to be that, and not to be none") {
  if (geteuid() != 0) return; // only root can be somebody else for a while
  const TemporaryFolder folder;
  const std::string mesh = folder.write("a.msh", msh(gmsh_cube, 5, {{1, 2, 3, 4, 5, 6, 7, 8}})),
                    geometry = folder.write("a.geo", "Point(1) = {0, 0, 0};\n");
  for (const std::string& path : {mesh, geometry}) fs::permissions(path, fs::perms::owner_read);
  const auto message_of = [](const std::string& path) -> std::string {
    constexpr uid_t nobody = 65534;
    REQUIRE(seteuid(nobody) == 0);
    std::string message;
    try {
      read_mesh({path, {}});
    } catch (const InputError& error) {
      message = error.what();
    }
    REQUIRE(seteuid(0) == 0);
    return message;
  };
  for (const bool is_open : {false, true}) { // the folder
    fs::permissions(folder.path, is_open ? fs::perms(0755) : fs::perms(0700));
    CHECK_THAT(message_of(mesh), Catch::Contains("a.msh: ") && Catch::Contains("Permission denied"));
    CHECK_THAT(message_of(geometry), Catch::Contains("a.geo: ") && Catch::Contains("Permission denied"));
  }
}

TEST_CASE("options that gmsh would read beside a geometry are refused") {
  const TemporaryFolder folder;
  const std::string geometry = folder.write("a.geo", "Point(1) = {0, 0, 0};\n");
  folder.write("a.geo.opt", "Mesh.MeshSizeMax = 1;\n");
  CHECK_THROWS_WITH(read_mesh({geometry, {}}), Catch::Contains("a.geo.opt: write them into the .geo"));
}

TEST_CASE("a geometry or mesh of a stranger runs nothing, writes nothing, and cannot end the program") {
  const TemporaryFolder folder;
  const std::string target = (folder.path / "written").string();
  const std::string surface = "SetFactory(\"OpenCASCADE\"); Rectangle(1) = {0, 0, 0, 1, 1};\n";
  for (const char* statement :
       {"SystemCall \"touch {}\";", "NonBlockingSystemCall \"touch {}\";", "Printf(\"text\") > \"{}\";",
        "Printf(\"text\") >> \"{}\";", "Save \"{}\";", "CreateDir \"{}\";"}) {
    INFO(statement);
    check_refused("a.geo", fmt::format(fmt::runtime(std::string(statement) + "\n"), target) + surface,
                  ""); // no cells, or the statement itself
    CHECK_FALSE(fs::exists(target));
  }
  check_refused("a.geo", "Exit;\n", "ended without an answer");
  check_refused("a.geo", "Abort;\n", "");
  const std::string mesh = folder.write("a.msh", msh(gmsh_cube, 5, {{1, 2, 3, 4, 5, 6, 7, 8}}));
  folder.write("a.msh.opt", "SystemCall \"touch " + target + "\"; Exit;\n");
  CHECK(read_mesh({mesh, {}}).cells.size() == 1);
  CHECK_FALSE(fs::exists(target));
}

TEST_CASE("a mesh with impossible numbers is refused, whatever gmsh makes of it") {
  const std::string sound = msh(gmsh_cube, 5, {{1, 2, 3, 4, 5, 6, 7, 8}});
  const auto with = [&](const std::string& before, const std::string& after) {
    std::string text = sound;
    const std::size_t at = text.find(before);
    REQUIRE(at != std::string::npos);
    return text.replace(at, before.size(), after);
  };
  for (const char* tag : {"-1", "0", "9223372036854775807", "18446744073709551615"}) {
    check_refused("a.msh", with("3 1 0 8\n1\n", fmt::format("3 1 0 8\n{}\n", tag)), "");
    check_refused("a.msh", with("101 1 2", fmt::format("101 {} 2", tag)), "");
  }
  check_refused("a.msh", with("$Nodes\n1 8 1 8", "$Nodes\n1 99999999999 1 99999999999"), "");
  check_refused("a.msh", with("$Elements\n1 1 101", "$Elements\n1 99999999999 101"), "");
}
