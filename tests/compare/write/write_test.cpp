#include "compare/write/write.hpp"

#include "cases/case/error.hpp"
#include "compare/provenance/whole_file.hpp"
#include "compare/write/gnuplot.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/unwrapped.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <unistd.h>

using namespace springproof;
namespace fs = std::filesystem;
using Catch::Contains;

namespace {

compare::Comparison one_cell_comparison() {
  compare::Comparison comparison;
  cases::Case definition;
  definition.name = "cell";
  definition.body = cases::Box{{1, 1, 1}, {1, 1, 1}};
  comparison.scene = cases::make_scene(definition);
  comparison.answers.msm.solution.status = cases::Status::converged;
  for (int n = 0; n < 8; ++n) comparison.answers.msm.solution.displacement.emplace_back(0.25 * n, 0, -1);
  comparison.answers.msm.solution.cell_volume = {1.5};
  comparison.answers.fem.solution.status = cases::Status::failed;
  comparison.answers.fem.solution.message = "limit point";
  comparison.measures = {{"L", "mm", std::nullopt, 2.5, std::nullopt}};
  return comparison;
}

/// Adds a traction on the upper face, MPa.
cases::Load& add_traction(compare::Comparison& comparison, const Eigen::Vector3d& value) {
  const cases::Load load{{"z+"}, cases::loads::Traction{value}};
  auto& loads = comparison.scene.loads;
  loads.push_back({cases::select(comparison.scene.mesh, load.region), load});
  return loads.back().load;
}

std::string text_of(const compare::Comparison& comparison) {
  std::ostringstream out;
  compare::write_text(out, comparison);
  return out.str();
}

std::string vtu_of(const compare::Comparison& comparison) {
  std::ostringstream out;
  compare::write_vtu(out, comparison);
  return out.str();
}

/// Values of an appended raw array of a .vtu, found by name as ParaView does.
template<class Value>
std::vector<Value> read_array(const std::string& vtu, const std::string& name) {
  const std::size_t tag = vtu.find("Name=\"" + name + "\"");
  REQUIRE(tag != std::string::npos);
  const std::size_t offset = std::stoul(vtu.substr(vtu.find("offset=\"", tag) + 8));
  const char* block = vtu.data() + vtu.find("_", vtu.find("<AppendedData")) + 1 + offset;
  std::uint64_t size = 0;
  std::memcpy(&size, block, sizeof size);
  std::vector<Value> values(size / sizeof(Value));
  std::memcpy(values.data(), block + sizeof size, size);
  return values;
}

/// A sweep's plot of one method, with any headline.
void draw_sweep(const TemporaryFolder& folder, const std::string& headline) {
  folder.write("plot.csv", "1,1\n2,2\n\n\n1,1\n\n\n1,1\n");
  compare::draw(folder.path.string(), "plot", "sweep",
                {{"headline", headline},
                 {"points", "plot.csv"},
                 {"time_label", "time, s"},
                 {"real_time", 0.},
                 {"methods", std::vector<std::string>{"one"}},
                 {"linetypes", std::vector{1.}},
                 {"markers", std::vector{0.}},
                 {"floors", std::vector{0.}},
                 {"uncertainty", 0.},
                 {"bottom", 0.1}});
}

} // namespace

TEST_CASE("a .vtu carries the mesh in VTK's order and the fields of the sides that converged") {
  const std::string vtu = vtu_of(one_cell_comparison());
  CHECK(vtu.find("NumberOfPoints=\"8\" ") != std::string::npos);
  CHECK(vtu.find("NumberOfCells=\"1\"") != std::string::npos);
  CHECK(read_array<std::int64_t>(vtu, "connectivity") == std::vector<std::int64_t>{0, 1, 3, 2, 4, 5, 7, 6});
  CHECK(read_array<std::uint8_t>(vtu, "types") == std::vector<std::uint8_t>{12});
  const auto displacement = read_array<double>(vtu, "msm_displacement");
  REQUIRE(displacement.size() == 24);
  CHECK(displacement[21] == 1.75);
  CHECK(displacement[23] == -1);
  CHECK(read_array<double>(vtu, "msm_cell_volume") == std::vector<double>{1.5});
  CHECK(vtu.find("fem_displacement") == std::string::npos);
  CHECK(vtu.find("difference") == std::string::npos);
}

TEST_CASE("a .vtu carries stress and forces with their units, errors, loads and materials") {
  compare::Comparison comparison = one_cell_comparison();
  cases::Solution &fem = comparison.answers.fem.solution, &msm = comparison.answers.msm.solution;
  fem.status = cases::Status::converged;
  fem.displacement.assign(8, {0, 0, -2});
  fem.displacement[7] = {0, 3, -4};
  fem.cell_volume = {1};
  fem.fields = cases::Fields{std::vector<Eigen::Vector3d>(8, {1, 2, 3}),
                             0.5,
                             true,
                             {0.5},
                             {{3, 0, 0, 0, 0, 0}},
                             {{0.1, 0.2, 0.3, 0.4, 0.5, 0.6}}};
  msm.fields = fem.fields;
  msm.fields->stress[0] = {4, 0, 0, 0, 0, 0};
  add_traction(comparison, {0, 0, 4});
  comparison.scene.material_of_cell = {2};
  const std::string vtu = vtu_of(comparison);
  CHECK(read_array<double>(vtu, "fem_stress") == std::vector<double>{3, 0, 0, 0, 0, 0});
  CHECK(read_array<double>(vtu, "fem_strain") == std::vector<double>{0.1, 0.2, 0.3, 0.4, 0.5, 0.6});
  CHECK(read_array<double>(vtu, "fem_von_mises")[0] == Approx(3).epsilon(1e-14));
  CHECK(read_array<double>(vtu, "msm_von_mises")[0] == Approx(4).epsilon(1e-14));
  CHECK(read_array<double>(vtu, "von_mises_difference")[0] == Approx(1).epsilon(1e-13));
  CHECK(read_array<double>(vtu, "fem_strain_energy_density")[0] == Approx(0.5).epsilon(1e-14));
  CHECK(read_array<double>(vtu, "fem_reaction")[2] == 3);
  CHECK(read_array<double>(vtu, "error")[0] == Approx(1).epsilon(1e-14));
  CHECK(read_array<double>(vtu, "relative_error")[0] == Approx(0.2).epsilon(1e-14)); // relative to 5 mm
  CHECK(read_array<double>(vtu, "applied_force")[3 * 7 + 2] == Approx(1).epsilon(1e-14));
  CHECK(read_array<double>(vtu, "material") == std::vector<double>{2});
  const std::size_t stress = vtu.find("Name=\"fem_stress\"");
  for (const char* part : {"UNITS_LABEL", "MPa", "ComponentName3=\"XY\""})
    CHECK(vtu.find(part, stress) < vtu.find("</DataArray>", stress));
}

TEST_CASE("the text says what force is applied and on what area") {
  compare::Comparison comparison = one_cell_comparison();
  add_traction(comparison, {0, 0.25, -4});
  const std::string text = text_of(comparison);
  CHECK_THAT(text, Catch::Contains("  body     1 x 1 x 1 mm, 1 mm3, 1 cells, 8 nodes\n"));
  CHECK_THAT(unwrapped(text),
             Catch::Contains(" loads    applied force (0, 0.25, -4) N; moment about (0.5, 0.5, 0.5) "
                             "(-0.125, 0, 0) N mm; load[0] on 1 mm2 "));
  const auto loads = nlohmann::json::parse(compare::to_json({comparison}).dump())["cases"][0]["loads"];
  CHECK(loads["force_N"][2] == -4.0);
  CHECK(loads["moment_N_mm"][0] == Approx(-0.125).epsilon(1e-14)); // rounding
  CHECK(loads["areas_mm2"]["load[0]"] == Approx(1).epsilon(1e-14));
}

TEST_CASE("the place that a moment is about is printed to six digits, as the moment is") {
  compare::Comparison comparison;
  cases::Case definition;
  definition.body = cases::Box{{1.0 / 3, 20.0 / 7, 1}, {1, 1, 1}};
  comparison.scene = cases::make_scene(definition);
  add_traction(comparison, {0, 0, -4});
  const std::string text = text_of(comparison);
  CHECK_THAT(text, Catch::Contains("moment about (0.166667, 1.42857, 0.5) (0, 0, 0) N mm"));
}

TEST_CASE("the error of a field is marked as a norm, which has no sign") {
  compare::Comparison comparison = one_cell_comparison();
  cases::Measure field{"everywhere", cases::measures::DisplacementFieldL2{}};
  comparison.scene.definition.measures = {field};
  comparison.measures = {{"everywhere", "mm", 2.0, 2.0, 12.5}};
  const std::string text = text_of(comparison);
  CHECK_THAT(text, Catch::Contains(" 12.50*\n") && !Catch::Contains("+12.50") &&
                       Catch::Contains("  * of a field over the body"));
}

TEST_CASE("what a program warns of is in its text and in its JSON, a sentence each and not in capitals") {
  compare::Comparison comparison = one_cell_comparison();
  comparison.scene.remarks = {"two pieces were left out"};
  comparison.answers.msm_warnings = {"held nodes have moved"};
  comparison.answers.design.emplace();
  comparison.answers.design->warnings = {"the lattice is too soft"};
  const std::string text = text_of(comparison);
  const auto warnings = nlohmann::json::parse(compare::to_json({comparison}).dump())["cases"][0]["warnings"];
  REQUIRE(warnings.size() == 3);
  for (const std::string warning : warnings) CHECK_THAT(text, Catch::Contains("  Warning: " + warning));
}

TEST_CASE("forces that follow a history are not added up as if their factors were 1") {
  compare::Comparison comparison = one_cell_comparison();
  add_traction(comparison, {0, 0, -4});
  add_traction(comparison, {0, 0, -4}).history.points = {{0, 0}, {1, 0.5}};
  const std::string text = text_of(comparison);
  CHECK_THAT(text, !Catch::Contains("applied force"));
  CHECK_THAT(text, Catch::Contains("  loads    load[0] on 1 mm2; load[1] on 1 mm2\n"));
  CHECK(vtu_of(comparison).find("applied_force") == std::string::npos);
}

TEST_CASE("springs are lines with their stretch and tension, where they are ours") {
  compare::Comparison comparison = one_cell_comparison();
  CHECK_FALSE(compare::has_drawn_springs(comparison)); // nobody has designed them
  msm::DesignResult design;
  design.springs = {{0.5, 0, 0, 0}}; // edges alone
  comparison.answers.design = design;
  auto& displacement = comparison.answers.msm.solution.displacement;
  displacement.assign(8, {0, 0, 0});
  for (std::size_t n = 4; n < 8; ++n) displacement[n] = {0, 0, -0.25}; // the upper face
  REQUIRE(compare::has_drawn_springs(comparison));
  std::ostringstream out;
  compare::write_springs_vtu(out, comparison, displacement);
  const std::string vtu = out.str();
  CHECK(read_array<std::uint8_t>(vtu, "types") == std::vector<std::uint8_t>(12, 3)); // lines
  const auto stretch = read_array<double>(vtu, "stretch"), tension = read_array<double>(vtu, "tension");
  REQUIRE(stretch.size() == 12);
  int n_pressed = 0;
  for (std::size_t s = 0; s < 12; ++s) {
    const bool is_pressed = stretch[s] < 0.9;
    n_pressed += is_pressed;
    CHECK(stretch[s] == Approx(is_pressed ? 0.75 : 1).epsilon(1e-14));
    CHECK(tension[s] == Approx(is_pressed ? -0.125 : 0).margin(1e-15));
  }
  CHECK(n_pressed == 4);

  msm::CellTerms cell; // a link and a tetrahedron, of which an edge is pressed
  cell.springs = {{{0, 1}, 0.5}};
  cell.tetrahedra = {{{0, 1, 2, 4}, 0.2, 0.1}};
  comparison.answers.design->springs = msm::BodyTerms{{cell}};
  std::ostringstream of_terms;
  compare::write_springs_vtu(of_terms, comparison, displacement);
  const auto pressed = read_array<double>(of_terms.str(), "stretch");
  REQUIRE(pressed.size() == 1 + 6);
  CHECK(std::count_if(pressed.begin(), pressed.end(), [](double q) { return q < 0.76; }) == 1); // 0 to 4
  const auto tensions = read_array<double>(of_terms.str(), "tension");
  CHECK(tensions[0] == Approx(0).margin(1e-15)); // the link
  CHECK(std::any_of(tensions.begin(), tensions.end(), [](double t) { return t < -1e-3; }));
  comparison.answers.msm_source = "another.vtu";
  CHECK_FALSE(compare::has_drawn_springs(comparison));
}

TEST_CASE("a failed side is a failed row with its reason, and its values are null, not numbers") {
  const auto document = nlohmann::json::parse(compare::to_json({one_cell_comparison()}).dump());
  CHECK(document["schema"] == 1);
  const auto& row = document["cases"][0];
  CHECK(row["status"] == "failed");
  CHECK(row["fem"]["status"] == "failed");
  CHECK(row["fem"]["message"] == "limit point");
  CHECK(row["measures"][0]["fem"].is_null());
  CHECK(row["measures"][0]["error_percent"].is_null());
  CHECK(row["measures"][0]["msm"] == 2.5);
  std::ostringstream csv;
  compare::write_csv(csv, {one_cell_comparison()});
  CHECK(csv.str() == "case,measure,unit,fem,msm,error_percent,fem_status,msm_status,"
                     "fem_discretisation_error_percent,peer,reference,fem_limit,fem_limit_uncertainty,"
                     "error_uncertainty_percent,error_same_mesh_percent\n"
                     "cell,L,mm,,2.5,,failed,converged,,,same_mesh,,,,\n");
}

TEST_CASE("a text in a plot is drawn as it stands, whatever gnuplot would make of it") {
  const TemporaryFolder folder;
  const std::string headline =
      GENERATE("Young's cube \\ {x_1} @y #z", "\"`touch P`\" $DATA << E", "x'; system 'touch P'; set title '",
               "x\nsystem 'touch P'\n", "'; system 'touch P'; x = '", "''; system 'touch P'", "'''");
  draw_sweep(folder, headline);
  CHECK_FALSE(fs::exists(folder.path / "P"));
  const std::string svg = compare::read_file((folder.path / "plot.svg").string());
  if (headline.front() == 'Y') CHECK_THAT(svg, Contains("Young's cube \\ {x_1} @y #z"));
}

TEST_CASE("a drawn figure leaves its pictures, its script, and nothing else") {
  const TemporaryFolder folder;
  draw_sweep(folder, "case");
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder.path)) names.push_back(entry.path().filename());
  std::sort(names.begin(), names.end());
  CHECK(names == std::vector<std::string>{"plot.csv", "plot.gp", "plot.png", "plot.svg"});
}

TEST_CASE("gnuplot's message is the error, and no picture is left") {
  const TemporaryFolder folder;
  CHECK_THROWS_WITH(compare::draw(folder.path.string(), "plot", "uniaxial"),
                    Contains("plot.gp") && Contains("gnuplot failed") && Contains("plot.csv"));
  CHECK_FALSE(fs::exists(folder.path / "plot.svg"));
}
