#include "cases/case/error.hpp"
#include "cases/case/read_case.hpp"
#include "compare/gates/comparison.hpp"
#include "compare/peers/external_side.hpp"
#include "compare/provenance/call_program.hpp"
#include "compare/write/write.hpp"
#include "msm/problem.hpp"
#include "tests/support/largest.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/temporary_folder.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <sstream>

using namespace springproof;

using compare::Transfer;
using Eigen::Vector3d;

namespace {

namespace fs = std::filesystem;

/// The body of tests/compare/peers/write_foreign.cpp, in so many cells.
cases::Mesh foreign_body(const std::array<int, 3>& cells) {
  cases::Mesh mesh = cases::make_box_mesh({3.1, 2.2, 1.7}, cells);
  for (Vector3d& node : mesh.nodes.stored()) node += Vector3d(0.7, -0.3, 5);
  return mesh;
}

/// Its displacement, mm.
Vector3d foreign_displacement(const Vector3d& x) {
  return {0.01 * x.y() * x.z(), 0.02 * x.x(), -0.01 * x.x() * x.x()};
}

/// Files by VTK's writers.
struct ForeignFiles {
  TemporaryFolder folder;
  std::vector<std::string> paths;
  ForeignFiles() {
    const auto end =
        compare::call_program({{SPRINGPROOF_WRITE_FOREIGN, folder.path.string()}, folder.path.string(), {}});
    REQUIRE(end.has_value());
    INFO(end->said);
    REQUIRE(end->status == 0);
    for (const auto& entry : fs::directory_iterator(folder.path)) paths.push_back(entry.path().string());
    std::sort(paths.begin(), paths.end());
  }
  std::string named(const std::string& name) const { return (folder.path / name).string(); }
};

/// A case whose body is that one, for results on other meshes.
cases::Scene scene_of(const cases::Mesh& mesh) {
  cases::Scene scene;
  scene.mesh = mesh;
  return scene;
}

std::vector<Vector3d> field(const cases::Mesh& mesh, const std::function<Vector3d(const Vector3d&)>& u) {
  std::vector<Vector3d> values;
  for (const Vector3d& node : mesh.nodes) values.push_back(u(node));
  return values;
}

double largest_error(const cases::Mesh& mesh, const std::vector<Vector3d>& found,
                     const std::function<Vector3d(const Vector3d&)>& u) {
  return largest_difference(found, field(mesh, u), [](const Vector3d& d) { return d.norm(); });
}

/// A .vtu on a mesh of hexahedra.
std::string vtu_on(const TemporaryFolder& folder, const cases::Mesh& mesh,
                   const std::function<Vector3d(const Vector3d&)>& u) {
  std::ostringstream out;
  compare::write_vtu(out, mesh, {{"displacement", field(mesh, u)}});
  return folder.write("other.vtu", out.str());
}

/// The finite elements' answer to a case is known here: a field.
compare::Answers answers_with(const cases::Mesh& mesh, const std::function<Vector3d(const Vector3d&)>& u) {
  compare::Answers answers;
  cases::Solution& fem = answers.fem.solution;
  fem.status = cases::Status::converged;
  fem.displacement = field(mesh, u);
  msm::measure_cells(mesh, fem);
  return answers;
}

/// A displacement (mm) that is curved in every direction.
Vector3d smooth(const Vector3d& x) {
  return {0.1 * std::sin(x.x() + 0.5 * x.y()), 0.05 * std::cos(x.y() - x.z()),
          0.02 * x.x() * x.z() + 0.03 * x.z() * x.z()};
}

const std::string legacy_head = "# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\n"
                                "POINTS 2 double\n0 0 0 1 0 0\nCELLS 0 0\nCELL_TYPES 0\n";

} // namespace

TEST_CASE("whatever VTK's writers leave is read and matched with the nodes: every type of file, encoding, "
          "compressor and "
          "precision") {
  const ForeignFiles files;
  const cases::Mesh mesh = foreign_body({3, 2, 2});
  std::map<std::string, int> n_of; // files by their ending
  for (const std::string& path : files.paths) {
    INFO(path);
    const auto displacement = compare::match_nodes(mesh, compare::read_displacements(path), path);
    const bool is_float = path.find("_float") != std::string::npos;
    // Components reach 0.15 mm; VTK writes doubles as text with eleven digits, floats with six.
    CHECK(largest_error(mesh, displacement, foreign_displacement) <= (is_float ? 1e-6 : 1e-11));
    ++n_of[fs::path(path).extension()];
  }
  CHECK(n_of == std::map<std::string, int>{
                    {".vti", 2}, {".vtk", 40}, {".vtp", 2}, {".vtr", 2}, {".vts", 2}, {".vtu", 34}});
}

TEST_CASE("files of meshio's default writers are read") { // meshio 5.0.0, of the body and displacement above
  const cases::Mesh mesh = foreign_body({3, 2, 2});
  for (const std::string file : {"meshio.vtu", "meshio.vtk"}) {
    const std::string path = SPRINGPROOF_SOURCE_DIR "/tests/compare/peers/" + file;
    const auto displacement = compare::match_nodes(mesh, compare::read_displacements(path), path);
    CHECK(largest_error(mesh, displacement, foreign_displacement) <= 1e-15);
  }
}

TEST_CASE("a .vtk file that ends too early is refused, or has all that is asked of it") {
  const ForeignFiles files;
  const cases::Mesh mesh = foreign_body({3, 2, 2});
  for (const std::string name :
       {"hexahedra_double_text_42.vtk", "hexahedra_double_binary_51.vtk", "image_float_text_51.vtk"}) {
    const std::string whole = content(files.named(name));
    for (std::size_t part = 0; part < 16; ++part) {
      const std::string cut = whole.substr(0, whole.size() * part / 16);
      INFO(name << " cut to " << cut.size() << " of " << whole.size());
      try {
        const auto displacement =
            compare::match_nodes(mesh, compare::read_displacement_vtk(cut, "a.vtk"), "a.vtk");
        CHECK(largest_error(mesh, displacement, foreign_displacement) <= 1e-6);
      } catch (const cases::InputError& error) {
        CHECK_THAT(error.what(), Catch::StartsWith("a.vtk: "));
      }
    }
  }
}

TEST_CASE("a VTK file that cannot be used is refused with what it has and what is wanted") {
  const auto [text, message] = GENERATE(table<std::string, std::string>({
      {"x,y,z\n", "neither the first line of a .vtk file nor a tag <VTKFile"},
      {"<VTKFile type=\"PUnstructuredGrid\" version=\"1.0\"><PUnstructuredGrid/></VTKFile>",
       "its type is PUnstructuredGrid, must be UnstructuredGrid"},
      {"<VTKFile type='vtkMultiBlockDataSet'></VTKFile>", "its type is vtkMultiBlockDataSet"},
      {"# vtk DataFile Version 3.0\nx\nASCII\nDATASET TABLE\nROW_DATA 0\n",
       "its data set is none of UNSTRUCTURED_GRID"},
      {"# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nPOINTS 0 float\n", "it has no points"},
      {legacy_head, "it has none"},
      {legacy_head + "POINT_DATA 2\nFIELD f 1\nu 2 2 double\n0 0 1 1\n", "it has 'u' of 2 components"},
      {legacy_head + "POINT_DATA 2\nFIELD f 1\nu 3 2 int\n0 0 0 1 1 1\n", "it has 'u' of type int"},
      {legacy_head + "POINT_DATA 2\nVECTORS a double\n0 0 0 1 1 1\nVECTORS b double\n0 0 0 1 1 1\n",
       "it has 'a', 'b'"},
      {"# vtk DataFile Version 3.0\nx\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 2 1 1\nORIGIN 0 0 "
       "0\nSPACING 1 1 1\n"
       "CELL_DATA 1\nVECTORS displacement double\n0 0 0\n",
       "it has 'displacement' of cells"},
  }));
  CHECK_THROWS_WITH(compare::read_displacement_vtk(text, "a.vtk"),
                    Catch::Contains(message) && Catch::StartsWith("a.vtk: "));
}

TEST_CASE("nodes are matched within a millionth of the body's size, whatever its size") {
  for (const double size : {1e-3, 1., 1e4}) {
    const cases::Mesh mesh = cases::make_box_mesh(size * Vector3d::Ones(), {3, 3, 3});
    std::vector<compare::GivenDisplacement> given;
    for (const Vector3d& node : mesh.nodes) given.push_back({node * (1 + 3e-7), Vector3d::Zero(), "a:1"});
    CHECK_NOTHROW(compare::match_nodes(mesh, given, "a"));
    given[5].position.x() += 3e-6 * size;
    CHECK_THROWS_WITH(compare::match_nodes(mesh, given, "a"), Catch::Contains("need --interpolate"));
  }
}

TEST_CASE("results on another mesh are interpolated in their cells: linear fields exactly",
          "[verification]") {
  const ForeignFiles files;
  const auto linear = [](const Vector3d& x) -> Vector3d {
    return {0.1 * x.y(), 0.02 * x.x() - 0.3 * x.z(), 1 + x.x()};
  };
  const cases::Mesh mesh = foreign_body({5, 4, 3});
  const TemporaryFolder folder;
  const auto found = compare::read_external(
      {{scene_of(mesh), {}}}, vtu_on(folder, foreign_body({3, 2, 2}), linear), Transfer::interpolated);
  REQUIRE(found);
  CHECK(largest_error(mesh, found->solution.displacement, linear) <= 1e-12); // displacements are some 4 mm
  // Its x² loses up to h²/8 times its second derivative of 0.02; y z nothing in hexahedra.
  for (const std::string name :
       {"tetrahedra_double.vtu", "image_double.vti", "hexahedra_float_binary_51.vtk"}) {
    const auto file =
        compare::read_external({{scene_of(mesh), {}}}, files.named(name), Transfer::interpolated);
    const double h = 3.1 / 3, error = largest_error(mesh, file->solution.displacement, foreign_displacement);
    INFO(name);
    CHECK(error <= 1.001 * (0.02 * h * h / 8 + (name[0] == 't' ? 0.01 * 1.1 * 0.85 / 4 : 0)));
    CHECK(error >= 0.3 * 0.02 * h * h / 8);
  }
}

TEST_CASE("the stated error of interpolation is at least the true one, and not four times as large",
          "[verification]") {
  const TemporaryFolder folder;
  const cases::Mesh mesh = foreign_body({9, 8, 7});
  for (const int n : {3, 6, 11, 20}) { // the results' mesh: coarser and finer than the case's
    const auto external = compare::read_external(
        {{scene_of(mesh), {}}}, vtu_on(folder, foreign_body({n, n, n}), smooth), Transfer::interpolated);
    const compare::Answers answers =
        compare::with_displacements(answers_with(mesh, smooth), scene_of(mesh), *external);
    REQUIRE(answers.interpolated);
    const double true_error = largest_error(mesh, answers.msm.solution.displacement, smooth),
                 stated =
                     largest_difference(answers.interpolated->fem_and_back.solution, answers.fem.solution);
    INFO(n << ": true " << true_error << ", stated " << stated);
    CHECK(stated >= true_error);
    // The results' own mesh is the coarser one; where it is the finer one, the case's mesh adds its part.
    CHECK(stated <= 4 * std::max(true_error, 0.1 * std::pow(3.1 / 9, 2) / 8));
    CHECK(answers.interpolated->n_points == std::size_t((n + 1) * (n + 1) * (n + 1)));
    CHECK(answers.interpolated->n_outside == 0);
  }
}

TEST_CASE("results on the case's own nodes are interpolated without any error") {
  const TemporaryFolder folder;
  const cases::Mesh mesh = foreign_body({3, 2, 2});
  const auto external =
      compare::read_external({{scene_of(mesh), {}}}, vtu_on(folder, mesh, smooth), Transfer::interpolated);
  CHECK(largest_error(mesh, external->solution.displacement, smooth) <= 1e-14);
  const compare::Answers answers =
      compare::with_displacements(answers_with(mesh, smooth), scene_of(mesh), *external);
  CHECK(largest_difference(answers.interpolated->fem_and_back.solution, answers.fem.solution) <= 1e-14);
}

// Other places checked for this defect: the way back, in trilinear hexahedra (VTK's search ends at 1e-9
// there), surfaces bound to cells (mechanics/surface, by place_in_cell()), structured and rectilinear grids
// (hexahedra and voxels along the axes).
TEST_CASE("in curved quadratic cells, and on their nodes, a linear displacement is interpolated exactly",
          "[verification]") {
  const auto curved = [](const Vector3d& p) -> Vector3d { // maps the unit cube
    return {2 * p.x() + 0.3 * p.y() * p.y() - 0.2 * p.x() * p.z(), 1.5 * p.y() + 0.25 * p.x() * p.x(),
            p.z() + 0.2 * p.x() * p.y() - 0.15 * p.y() * p.y()};
  };
  const auto linear = [](const Vector3d& x) -> Vector3d {
    return {0.1 * x.y() + 0.02 * x.x(), 0.02 * x.x() - 0.3 * x.z(), 1 + x.x()};
  };
  const int places[27][3] = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {0, 0, 2}, {2, 0, 2}, {2, 2, 2},
                             {0, 2, 2}, {1, 0, 0}, {2, 1, 0}, {1, 2, 0}, {0, 1, 0}, {1, 0, 2}, {2, 1, 2},
                             {1, 2, 2}, {0, 1, 2}, {0, 0, 1}, {2, 0, 1}, {2, 2, 1}, {0, 2, 1}, {0, 1, 1},
                             {2, 1, 1}, {1, 0, 1}, {1, 2, 1}, {1, 1, 0}, {1, 1, 2}, {1, 1, 1}}; // VTK's order
  std::string points, values, numbers;
  for (int n = 0; n < 27; ++n) {
    const Vector3d x = curved(Vector3d(places[n][0], places[n][1], places[n][2]) / 2), u = linear(x);
    points += fmt::format("{:.17g} {:.17g} {:.17g}\n", x.x(), x.y(), x.z());
    values += fmt::format("{:.17g} {:.17g} {:.17g}\n", u.x(), u.y(), u.z());
    numbers += fmt::format(" {}", n);
  }
  const TemporaryFolder folder;
  const std::string path = folder.write(
      "curved.vtk", "# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 27 double\n" +
                        points + "CELLS 1 28\n27" + numbers +
                        "\nCELL_TYPES 1\n29\nPOINT_DATA 27\nVECTORS displacement double\n" + values);
  for (const int n : {2, 5}) { // the cell's own nodes, and others
    cases::Mesh mesh = cases::make_box_mesh({1, 1, 1}, {n, n, n});
    for (Vector3d& node : mesh.nodes.stored()) node = curved(node);
    mesh.grid.reset();
    const auto found = compare::read_external({{scene_of(mesh), {}}}, path, Transfer::interpolated);
    CHECK(largest_error(mesh, found->solution.displacement, linear) <= 1e-12); // displacements are some 3 mm
  }
}

TEST_CASE("an image that is turned by its direction is where it is") {
  const cases::Mesh rest = cases::make_box_mesh({3, 2, 2}, {3, 2, 2});
  const auto turned = [](const Vector3d& x) -> Vector3d { return {-x.y(), x.x(), x.z()}; };
  cases::Mesh mesh = rest;
  std::string values;
  for (Vector3d& node : mesh.nodes.stored()) {
    node = turned(node);
    const Vector3d u = smooth(node);
    values += fmt::format("{:.17g} {:.17g} {:.17g}\n", u.x(), u.y(), u.z());
  }
  mesh.grid.reset();
  const TemporaryFolder folder;
  const std::string path = folder.write(
      "turned.vti", "<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\"><ImageData "
                    "WholeExtent=\"0 3 0 2 0 2\" Origin=\"0 0 0\" Spacing=\"1 1 1\" Direction=\"0 -1 0 1 0 0 "
                    "0 0 1\"><Piece Extent=\"0 3 0 2 0 2\"><PointData><DataArray type=\"Float64\" "
                    "Name=\"displacement\" NumberOfComponents=\"3\" format=\"ascii\">\n" +
                        values + "</DataArray></PointData></Piece></ImageData></VTKFile>\n");
  const auto found = compare::read_external({{scene_of(mesh), {}}}, path, Transfer::interpolated);
  CHECK(largest_error(mesh, found->solution.displacement, smooth) <= 1e-12);
}

TEST_CASE("nodes a little outside of the results' cells take the closest value, and are counted, far ones "
          "are refused") {
  const TemporaryFolder folder;
  const cases::Mesh other = foreign_body({4, 4, 4});
  cases::Mesh mesh = foreign_body({4, 4, 4});
  for (Vector3d& node : mesh.nodes.stored()) node.x() += 0.1;
  const std::string path = vtu_on(folder, other, [](const Vector3d& x) -> Vector3d { return {x.x(), 0, 0}; });
  const auto external = compare::read_external({{scene_of(mesh), {}}}, path, Transfer::interpolated);
  const compare::Answers answers = compare::with_displacements({}, scene_of(mesh), *external);
  CHECK(answers.interpolated->n_outside == 25);
  CHECK(answers.interpolated->largest_distance == Approx(0.1));
  CHECK(external->solution.displacement.back().x() == Approx(3.8)); // the other body's end
  CHECK(answers.interpolated->fem_and_back.converged() == false); // no finite elements: nothing to try it on
  for (Vector3d& node : mesh.nodes.stored()) node.x() += 1;
  CHECK_THROWS_WITH(compare::read_external({{scene_of(mesh), {}}}, path, Transfer::interpolated),
                    Catch::StartsWith(path + ": cannot be interpolated: has no cell at (") &&
                        Catch::Contains("half"));
}

TEST_CASE("results that nothing interpolates between are refused with the reason") {
  const ForeignFiles files;
  const cases::Mesh mesh = foreign_body({5, 4, 3});
  const auto read = [&](const std::string& path) {
    return compare::read_external({{scene_of(mesh), {}}}, path, Transfer::interpolated);
  };
  CHECK_THROWS_WITH(read(files.named("points_double.vtp")), Catch::Contains("has no cells of a volume"));
  CHECK_THROWS_WITH(read(files.folder.write("a.csv", "x,y,z,ux,uy,uz\n")),
                    Catch::Contains("which a .csv does not have"));
  CHECK_THROWS_WITH(read(files.folder.write("a.vtu", "x")), Catch::Contains("neither the first line"));
}

TEST_CASE("the output states what interpolation may add, and a gate must hold for it") {
  const TemporaryFolder folder;
  const std::string example = SPRINGPROOF_SOURCE_DIR "/cases/external/pulled_bar.toml";
  const cases::Case definition = cases::read_case(example);
  // Bars twice and half as fine as the case's 8 x 2 x 2... cells pulled by a known field.
  const auto pulled = [](const Vector3d& x) -> Vector3d {
    return {0.01 * x.x() * x.x(), -0.01 * x.y() * x.x(), 0};
  };
  const cases::Mesh body = cases::make_scene(definition).mesh;
  Eigen::AlignedBox3d box;
  for (const Vector3d& node : body.nodes) box.extend(node);
  const std::string path = vtu_on(folder, cases::make_box_mesh(box.sizes(), {3, 3, 3}), pulled);
  check_refused("run --json --msm-displacements " + path + " " + example, "need --interpolate");
  const ProgramRun run = run_program("run --json --interpolate --msm-displacements " + path + " " + example);
  const auto found = nlohmann::json::parse(run.out)["cases"][0];
  CHECK(found["msm"]["interpolated"]["points"] == 64);
  CHECK(found["msm"]["interpolated"]["nodes_outside"] == 0);
  for (const auto& measure : found["measures"]) CHECK(measure["interpolation_error"].get<double>() >= 0);
  const ProgramRun text = run_program("run --interpolate --msm-displacements " + path + " " + example);
  CHECK_THAT(text.out, Catch::Contains("interpolated between 64 points\n") &&
                           Catch::Contains("fem's displacement, interpolated there and back"));
  check_refused("run --interpolate " + example, "--msm-displacements");
}
