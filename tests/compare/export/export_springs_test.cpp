#include "compare/export/export_springs.hpp"

#include "cases/case/error.hpp"
#include "cases/case/read_case.hpp"
#include "compare/provenance/call_program.hpp"
#include "compare/provenance/machine.hpp"
#include "tests/support/largest.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/scene_in_tetrahedra.hpp"
#include "tests/support/temporary_folder.hpp"

#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>

using namespace springproof;

using compare::ExportTarget;

namespace {

/// A cuboid of 3 x 2 x 2 cells under the thesis's small shear.
msm::Problem springs_of(std::vector<std::string> settings) {
  settings.insert(settings.end(), {"body.size=[3, 2, 2]", "body.cells=[3, 2, 2]"});
  return compare::exported_problem(cases::make_scene(
      cases::read_case(compare::cases_folder() + "/thesis/linear_elastic/cube_shear_small.toml", settings)));
}

/// Every node moved by up to 0.15 mm in each direction, of cells of 1 mm.
msm::Points any_displacement(std::size_t n_nodes) {
  std::mt19937 generator(20261122);
  const auto any = [&] { return 0.3 * (double(generator()) / 4294967295.0) - 0.15; };
  msm::Points displacement;
  for (std::size_t n = 0; n < n_nodes; ++n) {
    const double x = any(), y = any(), z = any();
    displacement.emplace_back(x, y, z);
  }
  return displacement;
}

/// State that rebuild_forces.py reads: a line for each point.
std::string state_of(const msm::Problem& problem, const msm::Points& displacement) {
  const msm::Points force = msm::internal_force_at(problem.lattice, displacement),
                    load = problem.on_all_points(problem.force),
                    motion = problem.on_all_points(problem.supports ? problem.supports(1)
                                                                    : std::vector<cases::NodeVector>{});
  std::string text;
  for (std::size_t n = 0; n < displacement.size(); ++n) {
    std::vector<double> line;
    for (const Eigen::Vector3d& of : {displacement[n], force[n]})
      line.insert(line.end(), of.data(), of.data() + 3);
    for (std::size_t a = 0; a < 3; ++a) line.push_back(problem.is_constrained[3 * n + a]);
    line.insert(line.end(), load[n].data(), load[n].data() + 3);
    line.insert(line.end(), motion[n].data(), motion[n].data() + 3);
    text += fmt::format("{}\n", fmt::join(line, ","));
  }
  return text;
}

compare::ProgramEnd called(const TemporaryFolder& folder, const std::vector<std::string>& words) {
  const auto end = compare::call_program({words, folder.path.string(), {"PYTHONDONTWRITEBYTECODE=1"}});
  REQUIRE(end.has_value());
  return *end;
}

/// Has the package compare its own references of the forces with check.csv. Both sum forces of some ten
/// springs a node, each with an error of rounding of 1e-16 over a strain of 0.05.
void check_references(const TemporaryFolder& folder, bool has_csharp) {
  const auto end = called(folder, {"/usr/bin/python3", "forces.py"});
  INFO(end.said);
  CHECK(end.status == 0);
  CHECK(std::stod(end.said.substr(end.said.find(" is ") + 4)) <= 1e-12);
  if (!has_csharp) return;
  folder.write("Program.cs", "class Program { static int Main(string[] words) { System.Console.WriteLine("
                             "Springproof.Forces.Check(words[0]).ToString(\"R\")); return 0; } }");
  if (!compare::call_program({{"mcs", "-out:forces.exe", "Forces.cs", "Program.cs"}, folder.path, {}})) {
    WARN("Forces.cs was not run: no mcs (Debian's mono-mcs)");
    return;
  }
  const auto csharp = called(folder, {"mono", "forces.exe", folder.path.string()});
  INFO(csharp.said);
  CHECK(csharp.status == 0);
  CHECK(std::stod(csharp.said) <= 1e-12);
}

/// Exports a problem and has its forces rebuilt by a program that knows the files alone.
void check_rebuilt(ExportTarget target, const msm::Problem& problem, bool has_csharp = false) {
  const TemporaryFolder folder;
  compare::export_springs(folder.path, target, "cube", problem);
  if (target != ExportTarget::vtu) check_references(folder, has_csharp && target == ExportTarget::csv);
  const std::string state =
      folder.write("state", state_of(problem, any_displacement(problem.lattice.rest.size())));
  const auto end =
      called(folder, {"/usr/bin/python3", SPRINGPROOF_SOURCE_DIR "/tests/compare/export/rebuild_forces.py",
                      folder.path.string(), cases::name_of(target), state});
  INFO(end.said);
  CHECK(end.status == 0);
}

/// Rows of a CSV file without its header.
std::vector<std::vector<std::string>> rows_of(const TemporaryFolder& folder, const char* name) {
  std::vector<std::vector<std::string>> all;
  std::istringstream lines(content(folder.path / name));
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line)) {
    std::istringstream words(line);
    all.emplace_back();
    for (std::string word; std::getline(words, word, ',');) all.back().push_back(word);
  }
  return all;
}

} // namespace

TEST_CASE("a program that knows the exported files alone rebuilds the springs' forces", "[verification]") {
  const std::vector<std::vector<std::string>> springs_alone{
      {"msm.design=moduli"},
      {"msm.design=uniform"},
      {"msm.design=van_gelder"},
      {"msm.design=given", "msm.axis_stiffness=[30, 40, 50, 20, 25, 30, 35]"},
      {"fixed=[{region='z-', components=['x', 'z']}, {region='z- x-'}]"},
      {"msm.design=moduli", "moved=[{region='z+', displacement=[0, 0, 0.1], components=['z']}]"}};
  for (const auto& settings : springs_alone) {
    INFO(fmt::format("{}", fmt::join(settings, " ")));
    const msm::Problem problem = springs_of(settings);
    for (const ExportTarget target : {ExportTarget::csv, ExportTarget::sofa, ExportTarget::vtu})
      check_rebuilt(target, problem);
  }
}

TEST_CASE("CSV files and SOFA's scene hold volume terms, midlines, exponents and tetrahedra too",
          "[verification][long]") {
  const std::vector<std::vector<std::string>> other_terms{
      {"msm.design=hybrid"}, {"msm.design=matched"}, {"msm.design=midline"}, {"msm.design=biquadratic"}};
  for (const auto& settings : other_terms) {
    INFO(settings.front());
    const msm::Problem problem = springs_of(settings);
    for (const ExportTarget target : {ExportTarget::csv, ExportTarget::sofa})
      check_rebuilt(target, problem, true);
  }
  cases::Case definition = cases::read_case(
      compare::cases_folder() + "/thesis/linear_elastic/cube_shear_small.toml", {"body.cells=[2, 2, 2]"});
  definition.msm = {};
  for (const cases::Design design : {cases::Design::hybrid, cases::Design::matched}) { // volumes at nodes
    definition.msm.design = design;
    const msm::Problem problem =
        compare::exported_problem(tetrahedra::make_scene(definition, cases::Element::p1));
    REQUIRE_FALSE(problem.lattice.volume_patches.empty());
    for (const ExportTarget target : {ExportTarget::csv, ExportTarget::sofa})
      check_rebuilt(target, problem, true);
  }
  check_rebuilt(ExportTarget::vtu,
                springs_of({"msm.design=moduli", "msm.law=power_log", "msm.exponent=-1.5"}));
}

TEST_CASE("exported springs are read back as a network of the same forces", "[verification]") {
  for (const std::string design : {"linear_method", "matched"}) {
    const TemporaryFolder folder;
    msm::Problem problem = springs_of({"msm.design=" + design});
    compare::export_springs(folder.path, ExportTarget::csv, "cube", problem);
    problem.lattice.volume_cells.clear(); // the network's springs are Hooke's and power-log ones alone
    const msm::Lattice network =
        msm::make_lattice(problem.mesh, cases::read_network(content(folder.path / "springs.csv"),
                                                            "springs.csv", problem.mesh.nodes.size()));
    CHECK(network.links.size() == problem.lattice.links.size());
    const msm::Points at = any_displacement(problem.mesh.nodes.size()),
                      expected = msm::internal_force_at(problem.lattice, at),
                      found = msm::internal_force_at(network, at);
    double largest = 0, difference = 0;
    for (std::size_t n = 0; n < at.size(); ++n) {
      largest = larger(largest, expected[n].norm());
      difference = larger(difference, (found[n] - expected[n]).norm());
    }
    CHECK(difference <= 1e-14 * largest); // N/m and back rounds twice
  }
}

TEST_CASE("a skin's vertices are weighted sums of nodes, and masses are those of the body") {
  const TemporaryFolder folder;
  const cases::Scene scene = cases::make_scene(
      cases::read_case(compare::cases_folder() + "/league/organ.toml", {"msm.design=hybrid"}));
  const msm::Problem problem = compare::exported_problem(scene);
  const compare::ExportedBody body = compare::exported_body(scene);
  compare::export_springs(folder.path, ExportTarget::csv, "organ", problem, body);
  msm::Points places(body.skin.rest.vertices.size(), Eigen::Vector3d::Zero());
  for (const auto& row : rows_of(folder, "skin_weights.csv"))
    places.at(std::stoul(row[0])) += std::stod(row[2]) * problem.lattice.rest.at(std::stoul(row[1]));
  double farthest = 0;
  for (std::size_t v = 0; v < places.size(); ++v)
    farthest = larger(farthest, (places[v] - body.skin.rest.vertices[v]).norm());
  CHECK(farthest < 1e-9); // mm, of a body of some 100 mm
  CHECK(rows_of(folder, "skin_triangles.csv").size() == body.skin.rest.triangles.size());
  double mass = 0;
  for (const auto& row : rows_of(folder, "nodes.csv")) mass += std::stod(row.back());
  double expected = 0;
  for (const double of_point : body.mass) expected += 1e3 * of_point;
  CHECK(mass == Approx(expected).epsilon(1e-12));
  CHECK(mass > 0);
}

TEST_CASE("the tetrahedra in place of volume terms have their energy under a small change of volume") {
  const TemporaryFolder folder;
  const msm::Problem problem = springs_of({"msm.design=hybrid"});
  compare::export_springs(folder.path, ExportTarget::csv, "cube", problem);
  const double change = 0.001; // relative change of the volume
  double energy = 0, expected = 0;
  const auto rows = rows_of(folder, "volume_tetrahedra.csv");
  for (const auto& row : rows) {
    CHECK(std::stod(row[1]) > 0);
    energy += std::stod(row[0]) * std::stod(row[1]) * change * change / 2;
  }
  for (const msm::VolumeCell& cell : problem.lattice.volume_cells)
    expected += cell.stiffness * cell.rest_volume * change * change / 2;
  CHECK(rows.size() == 2 * 12);
  CHECK(energy == Approx(expected).epsilon(1e-12));
}

TEST_CASE("targets have the names of the command line") {
  CHECK(cases::all_names<ExportTarget>() == std::vector<std::string>{"sofa", "csv", "vtu"});
}

TEST_CASE("what a target cannot express is refused with its names") {
  CHECK_THROWS_WITH(
      compare::check_expressible(ExportTarget::vtu, "cube", springs_of({"msm.design=biquadratic"})),
      Catch::Contains("60 tetrahedra of biquadratic springs") && Catch::Contains("'cube'"));
}

TEST_CASE("what a file does not hold is said") {
  const TemporaryFolder folder;
  const auto said = [&](ExportTarget target, const msm::Problem& problem) {
    return fmt::format("{}", fmt::join(compare::export_springs(folder.path, target, "cube", problem), "\n"));
  };
  msm::Problem hybrid = springs_of({"msm.design=hybrid"});
  CHECK_THAT(said(ExportTarget::vtu, hybrid), Catch::Contains("not in it: the volume terms of 12 cells"));
  CHECK_THAT(said(ExportTarget::csv, hybrid),
             Catch::Contains("reads springs.csv alone") && !Catch::Contains("refuses"));
  CHECK_THAT(said(ExportTarget::vtu, springs_of({"msm.design=midline"})),
             Catch::Contains("not in it: 36 springs between the centres of faces"));
  hybrid.lattice.links.front().spring.stiffness *= -1;
  CHECK_THAT(said(ExportTarget::csv, hybrid), Catch::Contains("1 springs have a negative stiffness"));
}

TEST_CASE("a case's name is data of a SOFA scene and no part of its program") {
  const TemporaryFolder plain, hostile;
  const msm::Problem problem = springs_of({"msm.design=moduli"});
  const std::string name = "# coding: utf-7\n\"\"\"\nimport os; os.abort()\n'''\u2028\\";
  compare::export_springs(plain.path, ExportTarget::sofa, "cube", problem);
  compare::export_springs(hostile.path, ExportTarget::sofa, name, problem);
  CHECK(content(hostile.path / "scene.py") == content(plain.path / "scene.py"));
  const std::string data = content(hostile.path / "scene.json");
  CHECK(nlohmann::json::parse(data)["case"] == name);
  CHECK(std::all_of(data.begin(), data.end(), [](char c) { return c == '\n' || (c >= ' ' && c <= '~'); }));
}

TEST_CASE("an export that is refused leaves no folder, and one that is not says what it wrote") {
  const TemporaryFolder folder;
  const std::string out = (folder.path / "out").string();
  const std::string command =
      "export " + compare::cases_folder() + "/thesis/linear_elastic/cube_shear_small.toml --out " + out;
  check_refused(command + " --to vtu --set msm.design=biquadratic --set body.cells=[2,2,2]",
                "makes springs alone, which err by -");
  CHECK_FALSE(std::filesystem::exists(out));
  const ProgramRun written = run_program(command + " --to csv");
  CHECK(written.status == 0);
  CHECK(written.error.empty());
  CHECK(written.out.rfind("springs.csv: 14230 springs\n", 0) == 0); // 28 a cell, shared ones once
  for (const char* file : {"springs.csv", "nodes.csv", "volume_terms.csv", "tetrahedra.csv",
                           "skin_weights.csv", "skin_triangles.csv", "forces.py", "Forces.cs", "check.csv"})
    CHECK(std::filesystem::exists(out + "/" + file));
}
