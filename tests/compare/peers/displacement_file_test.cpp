#include "cases/case/error.hpp"
#include "compare/peers/external_side.hpp"
#include "compare/write/write.hpp"
#include "tests/support/case_text.hpp"

#include <catch2/catch.hpp>
#include <limits>
#include <sstream>

using namespace springproof;

using compare::read_displacement_csv;
using compare::read_displacement_vtk;

namespace {

std::string ascii_vtu(const std::string& points, const std::string& point_data) {
  return "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" "
         "byte_order=\"LittleEndian\">\n<UnstructuredGrid>\n"
         "<Piece NumberOfPoints=\"2\" NumberOfCells=\"0\">\n<Points>\n<DataArray type=\"Float64\" "
         "NumberOfComponents=\"3\" format=\"ascii\">\n" +
         points + "\n</DataArray>\n</Points>\n<PointData>\n" + point_data +
         "</PointData>\n<Cells>\n<DataArray type=\"Int64\" Name=\"connectivity\"/>\n"
         "<DataArray type=\"Int64\" Name=\"offsets\"/>\n<DataArray type=\"UInt8\" Name=\"types\"/>\n"
         "</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
}

std::string vectors(const std::string& name, const std::string& values) {
  return "<DataArray type=\"Float64\"\n Name=\"" + name + "\" NumberOfComponents=\"3\" format=\"ascii\">" +
         values + "</DataArray>\n";
}

const std::string two_points = "0 0 0 1 2.5 -3e-1", moves = "0 0 1 0 0.5 0";
const std::string one_array = ascii_vtu(two_points, vectors("a", moves));

} // namespace

TEST_CASE("a CSV of displacements gives a node per line and remembers where it stood") {
  const auto nodes =
      read_displacement_csv("x,y,z,ux,uy,uz\r\n0,1,2,1e-3,0,-0.5\n\n 3, 4,5 ,0,0,0\n", "a.csv");
  REQUIRE(nodes.size() == 2);
  CHECK(nodes[0].position == Eigen::Vector3d(0, 1, 2));
  CHECK(nodes[0].displacement == Eigen::Vector3d(1e-3, 0, -0.5));
  CHECK(nodes[1].where == "a.csv:4");
}

TEST_CASE("a CSV that is none is refused with the line and what is allowed") {
  const auto [text, message] = GENERATE(table<std::string, std::string>({
      {"", "a.csv:1: is empty, must begin with the header x,y,z,ux,uy,uz"},
      {"x,y,z\n1,2,3\n", "a.csv:1: is 'x,y,z', must be the header"},
      {"x,y,z,ux,uy,uz\n0,0,0,0,0\n", "a.csv:2: is '0,0,0,0,0', must be six finite numbers"},
      {"x,y,z,ux,uy,uz\n0,0,0,0,0,0\n0,0,0,0,0,nan\n", "a.csv:3"},
      {"x,y,z,ux,uy,uz\n0,0,0,0,0,1e999\n", "a.csv:2"},
      {"x,y,z,ux,uy,uz\n0,0,0,0,0,zero\n", "a.csv:2"},
      {"x,y,z,ux,uy,uz\nx0,0,0,0,0,0\n", "a.csv:2"},
      {"x,y,z,ux,uy,uz\n0,0,0,0,0,1 2\n", "a.csv:2"},
      {"0,0,0,0,0,0\n", "a.csv:1: is '0,0,0,0,0,0', must be the header"},
      {"x,y,z,ux,uy,uz\n0,0,0,0,0,0,0\n", "a.csv:2"},
  }));
  CHECK_THROWS_WITH(read_displacement_csv(text, "a.csv"), Catch::Contains(message));
}

TEST_CASE(
    "a .vtu in ASCII is read, and its displacements are found by name or because they are the only ones") {
  for (const std::string& data :
       {vectors("U", moves), vectors("force", two_points) + vectors("displacement", moves),
        vectors("fem_displacement", two_points) + vectors("msm_displacement", moves)}) {
    const auto nodes = read_displacement_vtk(ascii_vtu(two_points, data), "a.vtu");
    REQUIRE(nodes.size() == 2);
    CHECK(nodes[1].position == Eigen::Vector3d(1, 2.5, -0.3));
    CHECK(nodes[1].displacement == Eigen::Vector3d(0, 0.5, 0));
  }
}

TEST_CASE("the .vtu that this program writes is read back to the last bit") {
  const cases::Mesh mesh = cases::make_box_mesh({1, 2, 3}, {1, 2, 1});
  std::vector<Eigen::Vector3d> moved;
  for (const Eigen::Vector3d& x : mesh.nodes) moved.emplace_back(0.1 * x.y(), x.z() / 3, -1e-300);
  std::ostringstream out;
  compare::write_vtu(out, mesh, {{"msm_displacement", moved}, {"other", mesh.nodes.to_vector()}});
  const auto nodes = read_displacement_vtk(out.str(), "a.vtu");
  REQUIRE(nodes.size() == mesh.nodes.size());
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    CHECK(nodes[n].position == mesh.nodes[n]);
    CHECK(nodes[n].displacement == moved[n]);
  }
  const std::string cut = out.str().substr(0, out.str().size() - 500); // never beyond the end
  CHECK_THROWS_AS(read_displacement_vtk(cut, "a.vtu"), cases::InputError);
}

TEST_CASE("a displacement that is not finite is refused with its point") {
  const cases::Mesh mesh = cases::make_box_mesh({1, 2, 3}, {1, 1, 1});
  std::vector<Eigen::Vector3d> moved(8, {0, 0, 1});
  moved[5].y() = std::numeric_limits<double>::quiet_NaN();
  std::ostringstream out;
  compare::write_vtu(out, mesh, {{"displacement", moved}});
  CHECK_THROWS_WITH(read_displacement_vtk(out.str(), "a.vtu"), "a.vtu: is not finite at point 5");
}

TEST_CASE("a .vtu by VTK's writer as it comes, compressed and in single precision, matches the nodes that it "
          "rounds") {
  // vtkXMLUnstructuredGridWriter: the nodes of a box of 100.1 x 100.2 x 100.3 mm with displacement = position
  // / 1000
  const std::string path = SPRINGPROOF_SOURCE_DIR "/tests/compare/peers/single_precision.vtu";
  const auto nodes = compare::read_displacements(path);
  REQUIRE(nodes.size() == 8);
  const cases::Mesh mesh = cases::make_box_mesh({100.1, 100.2, 100.3}, {1, 1, 1});
  const auto displacement = compare::match_nodes(mesh, nodes, path);
  CHECK(nodes[7].position != mesh.nodes[7]);
  for (std::size_t n = 0; n < 8; ++n)
    CHECK((displacement[n] - mesh.nodes[n] / 1000).norm() <= 1e-6 * 0.1); // single precision
}

TEST_CASE("points that several pieces have in common are one node, if they move together") {
  const std::string text = ascii_vtu(two_points, vectors("U", moves));
  const std::size_t begin = text.find("<Piece"), end = text.find("</UnstructuredGrid>");
  const std::string piece = text.substr(begin, end - begin);
  const auto with = [&](const std::string& other) { return text.substr(0, end) + other + text.substr(end); };
  CHECK(read_displacement_vtk(with(piece), "a.vtu").size() == 2);
  CHECK(read_displacement_vtk(with(case_text::replaced(piece, moves, two_points)), "a.vtu").size() == 4);
}

TEST_CASE("a .vtu that cannot be used is refused with the reason") {
  const auto [text, message] = GENERATE(table<std::string, std::string>({
      {"", "is no VTK file that can be read: it has neither the first line of a .vtk file nor a tag"},
      {"<VTKFile type=\"PolyData\"></VTKFile>", "Cannot find PolyData element"},
      {"<VTKFile type=\"UnstructuredGrid\"><Piece NumberOfPoints=\"2\">", "no element found"},
      {case_text::replaced(one_array, "NumberOfPoints=\"2\"", "NumberOfPoints=\"-2\""),
       "\"a\" from PointData"},
      {ascii_vtu(two_points, vectors("a", moves) + vectors("b", moves)), "it has 'a', 'b'"},
      {ascii_vtu(two_points, ""), "it has none"},
      {ascii_vtu(two_points, vectors("a", "0 0 0")), "\"a\" from PointData in piece 0"},
      {ascii_vtu(two_points, vectors("a", "0 0 0 0 0 x")), "\"a\" from PointData in piece 0"},
      {ascii_vtu(two_points, vectors("a", "0 0 0 0 0 inf")), "\"a\" from PointData in piece 0"},
      {ascii_vtu(two_points,
                 "<DataArray Name=\"a\" type=\"Float64\" NumberOfComponents=\"3\" format=\"binary\">"),
       "mismatched tag"},
      {ascii_vtu(two_points, "<DataArray Name=\"a\" type=\"Int64\" NumberOfComponents=\"3\" "
                             "format=\"ascii\">0 0 1 0 1 0</DataArray>"),
       "(Float32 or Float64)"},
  }));
  CHECK_THROWS_WITH(read_displacement_vtk(text, "a.vtu"),
                    Catch::Contains(message) && Catch::StartsWith("a.vtu: "));
}

TEST_CASE("a VTK file that VTK's reader crashes on is refused") {
  std::string text = case_text::replaced(one_array, "NumberOfPoints=\"2\"", "NumberOfPoints=\"-27\"");
  text = case_text::replaced(text, "format=\"ascii\">\n" + two_points + "\n</DataArray>",
                             "format=\"appended\" offset=\"0\"/>");
  text =
      case_text::replaced(text, "</UnstructuredGrid>\n",
                          "</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_" +
                              std::string("\x88\2\0\0", 4) + std::string(648, '\0') + "\n</AppendedData>\n");
  CHECK_THROWS_WITH(read_displacement_vtk(text, "a.vtu"), Catch::StartsWith("a.vtu: "));
}

TEST_CASE("a file of another kind, and one that is not there, are refused by their names") {
  CHECK_THROWS_WITH(compare::read_displacements("a.txt"),
                    Catch::Contains("a.txt") && Catch::Contains(".csv"));
  CHECK_THROWS_AS(compare::read_displacements("/no/such/file.csv"), cases::InputError);
}
