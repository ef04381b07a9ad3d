// The program as its users run it: exit status, standard output, standard error, files.

#include "tests/support/run_program.hpp"
#include "tests/support/unwrapped.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace fs = std::filesystem;

namespace {

const std::string cases_folder = std::string(SPRINGPROOF_SOURCE_DIR) + "/cases";
const std::string shear = cases_folder + "/thesis/linear_elastic/cube_shear_small.toml";

/// A case's result has measures, and the errors of all of them.
void check_has_errors(const nlohmann::json& result) {
  REQUIRE_FALSE(result["measures"].empty());
  for (const auto& measure : result["measures"]) CHECK(measure["error_percent"].is_number());
}

/// Requires that a command with --out leaves these files.
void check_leaves(const std::string& words, const std::vector<std::string>& names) {
  const TemporaryFolder folder;
  const std::string out = (folder.path / "out").string();
  printed_by(words + " --out " + out);
  for (const std::string& name : names) {
    CAPTURE(name);
    CHECK(fs::file_size(fs::path(out) / name) > 100);
  }
}

} // namespace

TEST_CASE("every case that comes with the program runs, and --json prints one document and nothing else",
          "[long]") {
  std::string files;
  std::size_t n_cases = 0;
  for (const auto& entry : fs::recursive_directory_iterator(cases_folder + "/thesis")) {
    if (entry.path().extension() != ".toml") continue;
    ++n_cases;
    files += " " + entry.path().string();
  }
  REQUIRE(n_cases >= 12); // the cube alone: two materials, three tests, two load sets
  const auto document = document_of("run --json" + files);
  REQUIRE(document["cases"].size() == n_cases);
  for (const auto& result : document["cases"]) {
    INFO(result["name"]);
    check_has_errors(result);
    for (const char* side : {"fem", "msm"}) {
      const auto& solution = result[side];
      CHECK(solution["status"] == "converged");
      CHECK(solution["residual"].get<double>() <= 1e-9); // the bound that both solvers promise
      CHECK(solution["load_reached"] == 1.0);
      CHECK(solution["inverted_cells"] == 0);
    }
  }
}

TEST_CASE("one side alone is solved when asked for, and the other is skipped") {
  const auto document = document_of("run --json --only msm " + shear);
  CHECK(document["cases"][0]["fem"]["status"] == "skipped");
  CHECK(document["cases"][0]["measures"][0]["fem"].is_null());
  CHECK(document["cases"][0]["measures"][0]["msm"].is_number());
}

TEST_CASE("a broken case ends in exit status 2, one message and no files, even behind a good case") {
  const TemporaryFolder folder;
  const fs::path broken = folder.path / "broken.toml", out = folder.path / "out";
  std::ofstream(broken) << "schema = 1\nname = \"b\"\nbdoy = 3\n";
  const std::string words = "run " + shear + " " + broken.string() + " --out " + out.string();
  check_refused(words, "broken.toml:3:1: bdoy");
  check_refused(words, "body");
  CHECK_FALSE(fs::exists(out));
}

TEST_CASE("a region that selects nothing is refused before any solve, with its place in the file") {
  check_refused("run " + shear + " --set 'measure[0].top=\"near 1 2 3.5\"'", "no node within");
}

TEST_CASE("run --report needs a folder") {
  check_refused("run " + shear + " --report", "--out");
}

TEST_CASE(
    "run --out leaves results, a comparison, both models' fields and what is solved, and nothing temporary") {
  const TemporaryFolder folder;
  const fs::path out = folder.path / "out";
  REQUIRE(run_program("run " + shear + " --out " + out.string()).status == 0);
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(out)) names.push_back(entry.path().filename());
  CHECK_THAT(names,
             Catch::UnorderedEquals<std::string>({"results.json", "comparison.csv", "cube-shear-small.vtu",
                                                  "cube-shear-small_springs.vtu", "solved"}));
  CHECK(nlohmann::json::parse(content(out / "results.json"))["cases"].size() == 1);
  const std::string vtu = content(out / "cube-shear-small.vtu");
  for (const char* field :
       {"fem_displacement", "msm_displacement", "difference", "msm_cell_volume", "fem_stress", "msm_stress",
        "fem_von_mises", "msm_strain", "fem_strain_energy_density", "msm_reaction", "relative_error",
        "applied_force", "material"})
    CHECK(vtu.find("\"" + std::string(field) + "\"") != std::string::npos);
  const std::string springs = content(out / "cube-shear-small_springs.vtu");
  for (const char* field : {"stretch", "tension", "msm_displacement"})
    CHECK(springs.find("\"" + std::string(field) + "\"") != std::string::npos);
}

TEST_CASE("run --converge gives each measure an error bar, or the reason why there is none", "[long]") {
  const std::string words = "run --json --only fem --converge ";
  const auto side =
      document_of(words + cases_folder + "/studies/clamped_block_shear.toml")["cases"][0]["fem"];
  for (const char* measure : {"u_x", "u_z", "alpha"}) {
    CHECK(side["discretisation_error_percent"][measure].get<double>() > 0);
    CHECK(side["discretisation_error_percent"][measure].get<double>() < 20); // four cells across, first order
  }
  CHECK(side["mesh_study"]["refine"] == std::vector<int>{0, 1, 2});
  const auto none = document_of(words + shear)["cases"][0]["fem"];
  CHECK(none["discretisation_error_percent"]["alpha_1"].is_null());
  CHECK_THAT(none["mesh_study"]["measures"][0]["reason"].get<std::string>(),
             Catch::Contains("no continuum limit"));
}

TEST_CASE("errors are against the limit where there is one, and against the same mesh where there is none",
          "[long]") {
  const std::string block = cases_folder + "/gates/sheared_block.toml";
  const auto document = document_of("run --json " + block);
  for (const auto& m : document["cases"][0]["measures"]) {
    CHECK(m["reference"] == "limit");
    const double limit = m["fem_limit"], fem = m["fem"], msm = m["msm"];
    CHECK(m["error_percent"].get<double>() == Approx(100 * (msm / limit - 1)).epsilon(1e-12)); // rounding
    CHECK(m["error_same_mesh_percent"].get<double>() == Approx(100 * (msm / fem - 1)).epsilon(1e-12));
    CHECK(m["fem_error_percent"].get<double>() == Approx(100 * (fem / limit - 1)).epsilon(1e-12));
    CHECK(m["error_uncertainty_percent"].get<double>() ==
          Approx(100 * m["fem_limit_uncertainty"].get<double>() / limit * msm / limit).epsilon(1e-12));
    CHECK(std::abs(m["fem_error_percent"].get<double>()) > 3); // four cells across
  }
  const auto none = document_of("run --json " + block +
                                " --set fem.accuracy=none --set 'expect=[{measure=\"u_x\", "
                                "fem=[0, 1], reference=\"exact\", reason=\"a test\"}]'");
  const auto& on_mesh = none["cases"][0]["measures"][0];
  CHECK(on_mesh["reference"] == "same_mesh");
  CHECK(on_mesh["error_percent"] == on_mesh["error_same_mesh_percent"]);
  CHECK(on_mesh["fem_limit"].is_null());
  CHECK_THAT(unwrapped(printed_by("run " + shear)),
             Catch::Contains("errors are against the finite elements on the same mesh: load[0] is a "
                             "concentrated force"));
}

TEST_CASE("run ends with 1 when an expectation is missed or undecided, and gate says what decides it",
          "[long]") {
  const std::string block = cases_folder + "/gates/sheared_block.toml";
  const auto expecting = [](const std::string& interval) {
    return " --set 'expect=[{measure=\"u_x\", error_percent=" + interval +
           ", reference=\"converged\", reason=\"a test\"}]'";
  };
  CHECK(run_program("run " + block + expecting("[-12, -5]")).status == 0);
  CHECK(run_program("run " + block + expecting("[-5, 0]")).status == 1);
  const ProgramRun undecided = run_program("gate " + block + expecting("[-8.9, 11.1]")); // -8.8 +- 0.6
  CHECK(undecided.status == 1);
  CHECK_THAT(undecided.out, Catch::Contains("undecided") && Catch::Contains("--converge="));
  check_refused("gate " + block + " --set fem.accuracy=none", "fem.accuracy");
}

TEST_CASE("run --peer ccx is a third column, and says why when it stays empty") {
  const auto result =
      document_of("run --json --only fem --peer ccx " + shear + " --set fem.element=q1_bbar")["cases"][0];
  CHECK(result["peer"]["status"] == "skipped");
  CHECK_THAT(result["peer"]["message"].get<std::string>(), Catch::Contains("q1_bbar"));
  CHECK(result["measures"][0]["peer"].is_null());
}

TEST_CASE("the place for temporary files is no command, and where it takes none the peer has failed",
          "[long]") {
  const TemporaryFolder folder;
  const fs::path place = folder.path / "it's; touch P; '";
  fs::create_directory(place);
  const std::string words =
      "run --json --only fem --peer ccx " + shear +
      " --set fem.element=q1 --set fem.formulation=small_strain --set body.cells=[2,2,2]";
  const std::string go = "cd " + folder.path.string() + " && TMPDIR=";
  CHECK(run_program(words, go + "\"" + place.string() + "\" ").status <= 1);
  CHECK_FALSE(fs::exists(folder.path / "P"));
  CHECK(fs::is_empty(place));
  const ProgramRun none = run_program(words, go + "/proc ");
  CHECK(none.status <= 1);
  const auto result = nlohmann::json::parse(none.out)["cases"][0];
  CHECK(result["fem"]["status"] == "converged");
  CHECK(result["peer"]["status"] == "failed");
  CHECK_THAT(result["peer"]["message"].get<std::string>(), Catch::Contains("/proc/springproof-ccx"));
}

TEST_CASE("wrong usage is exit status 2: no command, an unknown option, an unknown table") {
  for (const char* words : {"", "run", "run --no-such-option x", "tables 9.9", "run /no/such/file.toml"}) {
    INFO(words);
    const ProgramRun outcome = run_program(words);
    CHECK(outcome.status == 2);
    CHECK_FALSE(outcome.error.empty());
  }
  CHECK(run_program("--help").status == 0);
}

TEST_CASE("design --json is one document with the keys that were promised") {
  const auto document = document_of("design --young 0.3 --poisson 0.35 --edge 1 --method hybrid --json");
  CHECK(document["schema"] == 1);
  CHECK(document["method"] == "hybrid");
  CHECK(document["stiffness_N_per_m"].size() == 3);
  CHECK(document["volume_stiffness_MPa"].get<double>() > 0);
  CHECK(document["residual"].is_null()); // a closed form minimises nothing
  CHECK(document["moduli"]["poissons_ratio"].get<double>() ==
        Approx(0.35).epsilon(1e-12)); // isotropic exactly
  CHECK(document["warnings"].empty());
  CHECK(document["stability"]["compression"].get<double>() < 1);
}

TEST_CASE("design --compare shows every method, and why one refuses", "[long]") {
  const auto methods = document_of("design --young 0.3 --poisson -0.2 --compare --json")["methods"];
  REQUIRE(methods.size() == 13);
  CHECK(methods[11]["method"] == "lloyd");
  CHECK(methods[11]["stiffness_N_per_m"].is_null());
  CHECK(methods[10]["cell"]["springs"].size() == 18);
  CHECK(methods[3]["method"] == "hybrid");
  CHECK(methods[3]["refused"].get<std::string>().find("-0.2") != std::string::npos);
}

TEST_CASE("a design without a meaning ends with exit status 2 and the reason") {
  const auto [words, reason] = GENERATE(table<std::string, std::string>({
      {"--poisson 0.3", "one material"},
      {"--young 0.3", "--poisson"},
      {"--young 0.3 --poisson 0.5", "nu < 0.5"},
      {"--young 0.3 --poisson -0.1 --method linear_method", "nu < 0.5"},
      {"--young -1 --poisson 0.3", "--young: is -1"},
      {"--young 0.3 --poisson -0.2 --method hybrid", "0.0"},
      {"--young 0.3 --poisson 0.3 --edge 0", "--edge"},
      {"--young 0.3 --poisson 0.3 --edge 1e300", "--edge: is 1e300"},
      {"--young 1e300 --poisson 0.3", "--young: is 1e300"},
      {"--neo-hookean 0.04 --method nonlinear_method --largest-strain 0", "--largest-strain: is 0"},
      {"--neo-hookean 0.04 --method nonlinear_method --largest-strain 1e10", "--largest-strain: is 1e+10"},
      {"--neo-hookean 0.04 --method multi_load --strain-range 0 1e10", "--strain-range"},
      {"--curve /dev/null --largest-strain 0.3", "--largest-strain: must be left out"},
      {"--young 0.3 --poisson 0.3 --neo-hookean 0.1", "one material"},
      {"--ogden-mu 0.1 0.2 --ogden-alpha 2", "equally many"},
      {"--neo-hookean -0.1 --method moduli", "--neo-hookean: is -0.1"},
      {"--curve /nonexistent.csv --method nonlinear_method --strain stretch --unit kPa", "cannot be read"},
      {"--curve /nonexistent.csv", "--curve: say what the columns of /nonexistent.csv are: --strain"},
      {"--curve /nonexistent.csv --strain stretch", "--unit \"Pa\" | \"kPa\" | \"MPa\""},
      {"--curve /nonexistent.csv --strain percent --unit kPa", "--strain"},
      {"--young 0.3 --poisson 0.3 --unit kPa", "are of the columns of --curve"},
      {"--neo-hookean 0.1 --method linear_method", "--poisson"},
  }));
  check_refused("design " + words, reason);
}

TEST_CASE("a negative Poisson's ratio is allowed for the moduli") {
  CHECK(run_program("design --young 0.3 --poisson -0.1 --method moduli").status == 0);
}

TEST_CASE("design --out draws the figures of its method") {
  check_leaves("design --neo-hookean 0.04 --method nonlinear_method",
               {"design.json", "uniaxial.csv", "uniaxial.svg", "contributions.svg", "figure_5_5.svg",
                "valley.csv", "valley.png"});
}

TEST_CASE("stress puts a hard case to its models, and says in one document what became of each") {
  const TemporaryFolder folder;
  const auto document =
      document_of("stress --json mechanism disconnected_piece --out " + folder.path.string());
  REQUIRE(document["cases"].size() == 2);
  const auto& side = document["cases"][0]["sides"][0];
  CHECK(document["cases"][0]["name"] == "mechanism");
  CHECK(side["side"] == "msm");
  CHECK(side["outcome"] == "mechanism");
  CHECK(side["met"] == true);
  CHECK(side["load_reached"] == 0.0);
  REQUIRE(document["cases"][1]["sides"].size() >= 2);
  for (const auto& refused : document["cases"][1]["sides"]) {
    CHECK(refused["outcome"] == "refused");
    CHECK_THAT(refused["message"].get<std::string>(), Catch::Contains("falls into 2 pieces"));
  }
  CHECK(nlohmann::json::parse(content(folder.path / "stress.json"))["cases"] == document["cases"]);
  CHECK_THAT(content(folder.path / "stress.txt"), Catch::Contains("2 of 2 hard cases ended as expected"));
}

TEST_CASE("a hard case that ends otherwise than expected makes stress answer 1, and the others go on") {
  const TemporaryFolder folder;
  std::string text = content(cases_folder + "/hard/mechanism.toml");
  const std::string expected = "outcome = \"mechanism\"";
  text.replace(text.find(expected), expected.size(), "outcome = \"limit point\"");
  const fs::path wrong = folder.path / "wrong.toml";
  std::ofstream(wrong) << text;
  const ProgramRun outcome = run_program("stress " + wrong.string() + " negative_face_diagonal");
  CHECK(outcome.status == 1);
  CHECK_THAT(outcome.out, Catch::Contains("outcome mechanism, expected limit point"));
  CHECK_THAT(outcome.out, Catch::Contains("1 of 2 hard cases ended as expected"));
}

TEST_CASE("springs without any stiffness are a mechanism, and nothing told of them is not a number") {
  const TemporaryFolder folder;
  std::string text = content(cases_folder + "/hard/mechanism.toml");
  for (const char* stiffness : {"[0, 0, 0]", "[1e-317, 0, 0]"}) {
    const std::size_t at = text.find("stiffness = ") + std::string("stiffness = ").size();
    text.replace(at, text.find('\n', at) - at, stiffness);
    const auto side =
        document_of("stress --json " + folder.write("nothing.toml", text))["cases"][0]["sides"][0];
    CHECK(side["outcome"] == "mechanism");
    CHECK(side["met"] == true);
  }
}

TEST_CASE("a hard case that does not exist is refused with the nearest name, and run refuses hard cases") {
  check_refused("stress mechansim", "did you mean \"mechanism\"?");
  check_refused("run " + cases_folder + "/hard/mechanism.toml", "stress: is a table, must be left out");
}

TEST_CASE("every template gives a case that runs, and nothing is ever overwritten", "[long]") {
  const TemporaryFolder folder;
  const std::string in_folder = "cd " + folder.path.string() + " && ";
  for (const char* name : {"box", "layers", "mesh", "organ", "tetrahedra", "voxels"}) {
    CAPTURE(name);
    const std::string new_case = std::string("new my-") + name + " --template " + name;
    printed_by(new_case, in_folder);
    CHECK(content(folder.path / ("my-" + std::string(name) + ".toml")).find("TEMPLATE") == std::string::npos);
    // The limit takes seconds, as `new` says. The mesh is a fair start: it errs by less than 5 %.
    const auto document = document_of("run --json my-" + std::string(name) + ".toml", in_folder);
    CHECK(document["cases"][0]["name"] == "my-" + std::string(name));
    check_has_errors(document["cases"][0]);
    for (const auto& measure : document["cases"][0]["measures"]) {
      CAPTURE(measure.dump());
      CHECK(std::abs(measure["fem_error_percent"].get<double>()) < 5);
    }
    check_refused(new_case, "nothing is overwritten", in_folder);
  }
  // The mesh's drawing alone is in the way.
  fs::remove(folder.path / "my-mesh.toml");
  check_refused("new my-mesh --template mesh", "nothing is overwritten", in_folder);
  CHECK_FALSE(fs::exists(folder.path / "my-mesh.toml"));
  for (const char* wrong : {"new ../up", "new .hidden", "new 'a b'", "new x --template bax"})
    check_refused(wrong, "new: ", in_folder);
}

TEST_CASE("a geometry that never ends is stopped, and is wrong input", "[long]") {
  const TemporaryFolder folder;
  const std::string file = folder.write("wedge.toml", content(cases_folder + "/templates/mesh.toml"));
  for (const char* geometry :
       {"Macro Again\nCall Again;\nReturn\nCall Again;\n", "For i In {0:1e300}\nEndFor\n"}) {
    folder.write("TEMPLATE.geo", geometry);
    check_refused("run " + file, "TEMPLATE.geo: ", "ulimit -S -t 4; ");
  }
}

TEST_CASE("eigen --json numbers the spaces from 1 as the thesis does") {
  const auto document = document_of("eigen --poisson 0 --json --body 2 --modes 6");
  CHECK(document["poissons_ratio"] == 0);
  CHECK(document["fem"].size() == 6);
  CHECK(document["msm"].size() == 9);
  CHECK(document["equivalent"][2]["fem_space"] == 5);
  CHECK(document["equivalent"][2]["msm_space"] == 8);
  CHECK(document["equivalent"][2]["distance"] == 5);
  CHECK(document["free_body"].size() > 0);
}

TEST_CASE("eigen takes every material, and an incompressible one with another Poisson's ratio") {
  check_refused("eigen --neo-hookean 0.05", "--poisson");
  const auto h_of = [](const std::string& words) { return document_of(words)["h"].get<double>(); };
  CHECK(h_of("eigen --neo-hookean 0.05 --poisson 0.4 --json") ==
        Approx(h_of("eigen --young 0.15 --poisson 0.4 --json")).epsilon(1e-9)); // 3 mu is Young's modulus
}

TEST_CASE("eigen --out leaves the diagram, the shapes and their pictures", "[long]") {
  check_leaves("eigen --poisson 0.35",
               {"dot_diagram.csv", "dot_diagram.svg", "dot_diagram.png", "coupling.csv", "fem_modes.vtu",
                "fem_modes.png", "msm_modes.vtu", "msm_modes.svg"});
}

TEST_CASE("a raw curve of a test bench makes springs of its tissue by every method") {
  const TemporaryFolder folder;
  // Neo-Hookean with mu = 1 kPa: nominal stresses mu (l - 1/l^2) at engineering strains.
  std::string text = "strain,stress\n";
  for (const double strain : {-0.1, -0.001, 0., 0.001, 0.1})
    text += nlohmann::json(strain).dump() + "," +
            nlohmann::json(1 + strain - 1 / ((1 + strain) * (1 + strain))).dump() + "\n";
  const std::string words =
      "design --json --curve " + folder.write("raw.csv", text) + " --strain engineering --unit kPa --method ";
  for (const std::string method : {"nonlinear_method", "hybrid", "matched", "multi_load"}) {
    CAPTURE(method);
    const auto document = document_of(words + method);
    // E = 3 mu; the secant at 0.1 % is off by half a per cent of that, the fit follows 10 %
    const double expected = method == "hybrid" || method == "matched" ? 0.003 : 0;
    if (expected > 0)
      CHECK(document["moduli"]["youngs_modulus"].get<double>() == Approx(expected).epsilon(0.005));
  }
  check_refused(words + "linear_method", "--poisson");
  printed_by(words + "linear_method --poisson 0.4");
}
