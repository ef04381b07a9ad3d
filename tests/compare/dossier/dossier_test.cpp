#include "cases/case/error.hpp"
#include "cases/case/installation.hpp"
#include "cases/case/read_case.hpp"
#include "compare/dossier/gate_list.hpp"
#include "compare/error_bars/auto_fem.hpp"
#include "compare/provenance/whole_file.hpp"
#include "tests/compare/gates/judged.hpp"
#include "tests/support/case_text.hpp"

#include <catch2/catch.hpp>
#include <sstream>

using namespace springproof;
using namespace compare;
using Catch::Matchers::Contains;

namespace {

const std::string block = R"(schema = 1
name = "block"
body = { shape = "box", size = [10, 10, 10], cells = [2, 2, 2] }
material = { model = "linear_elastic", youngs_modulus = 1, poissons_ratio = 0.3 }
fixed = [{ region = "z-" }]
load = [{ region = "z+", kind = "traction", value = [0, 0, 0.01] }]
fem = { formulation = "small_strain" }
measure = [{ name = "end", kind = "displacement", node = "near 0 0 10", component = "z" }]
)";

const AnswerQuestions never = [](const std::vector<Question>&) -> std::vector<Answers> {
  throw std::logic_error("nothing is to be solved");
};

ErrorBudget budget_of(ErrorPart mesh, ErrorPart step, double whole) {
  return {"end", {3., 0, ""}, mesh, step, {0., 0, "zero by construction"}, whole, ""};
}

std::vector<Json> of_section(const Json& document, const std::string& section) {
  std::vector<Json> found;
  for (const Json& one : document["missing"])
    if (one["section"] == section) found.push_back(one);
  return found;
}

} // namespace

TEST_CASE("the numerical bar of a value is the size of its parts but the law's, of the truth") {
  // The value is 10 % above the truth of 2 mm; 4 +- 1 % and 2 % of that are of its mesh and step.
  const NumericalBar bar = numerical_bar(budget_of({-4., 1, ""}, {2., 0, ""}, 10), 2.2);
  REQUIRE(bar.size);
  CHECK(*bar.size == Approx(0.14)); // 7 % of 2 mm
  CHECK(numerical_bar(budget_of({-4., 1, ""}, {2., 0, ""}, 10), -2.2).size == bar.size);
}

TEST_CASE("a numerical bar is not known where a part, or the truth, is not") {
  const NumericalBar no_mesh =
      numerical_bar(budget_of({std::nullopt, 0, "one lattice"}, {2., 0, ""}, 10), 2.2);
  CHECK_FALSE(no_mesh.size);
  CHECK(no_mesh.reason == "its mesh: one lattice");
  const NumericalBar no_truth = numerical_bar({"end", {}, {}, {}, {}, {}, "no limit"}, 2.2);
  CHECK_FALSE(no_truth.size);
  CHECK(no_truth.reason == "no limit");
}

TEST_CASE("an uncertainty has all that is known, and says whether that is all") {
  ModelAgainstDatum model;
  combine(model, std::nullopt);
  CHECK_FALSE(model.uncertainty);
  CHECK_FALSE(model.is_complete);
  combine(model, 0.5);
  CHECK(*model.uncertainty == 1); // two standard deviations
  CHECK_FALSE(model.is_complete);
  model.numerical.size = 2;
  model.input = 1;
  combine(model, 0.5);
  CHECK(*model.uncertainty == 3); // sqrt(2^2 + 2^2 + 1^2)
  CHECK(model.is_complete);
}

TEST_CASE("tests of the project are the rows of tables of what is checked") {
  const auto tests =
      project_tests("## Elements\n\n| what is checked | against | where |\n|---|---|---|\n"
                    "| patches | exact | `patch_test.cpp` |\n\ntext\n| body | q1 |\n|---|---|\n| cube | 1 |\n"
                    "## Springs\n| what is checked | against |\n|---|---|\n| forces | energy |\n");
  REQUIRE(tests.size() == 2);
  CHECK(tests[0].part == "Elements");
  CHECK(tests[0].checked == "patches");
  CHECK(tests[0].against == "exact");
  CHECK(tests[0].where == "patch_test.cpp");
  CHECK(tests[1].part == "Springs");
  CHECK(tests[1].where.empty());
}

TEST_CASE("the page that comes with the program lists its tests") {
  const auto tests = project_tests(read_file(cases::data_folder("verification") + "/verification.md"));
  const auto names = [&](const std::string& file) {
    return std::any_of(tests.begin(), tests.end(),
                       [&](const ProjectTest& one) { return one.where.find(file) != std::string::npos; });
  };
  CHECK(names("patch_test.cpp"));
  CHECK(names("manufactured_test.cpp"));
  CHECK(names("calculix_test.cpp"));
}

TEST_CASE("comments before the data tell what was measured") {
  CHECK(comments_of("# three drops,\n#of one beam\ncase,drop\n# later\n") == "three drops, of one beam");
  CHECK(comments_of("case,drop\n").empty());
}

TEST_CASE("a number leads to every gate that holds it, and to no other") {
  using cases::Quantity;
  GateList gates("own/");
  gates.add(judged::judge(judged::comparison({judged::expectation(Quantity::fem, {9, 11}),
                                              judged::expectation(Quantity::fem, {11, 12}),
                                              judged::expectation(Quantity::error_percent, {-20, 0})})));
  CHECK(gates.names_of("cube", "L", Quantity::fem) ==
        std::vector<std::string>{"own/cube: L fem", "own/cube: L fem (2)"});
  CHECK(gates.names_of("cube", "L", Quantity::msm).empty());
  CHECK(gates.names_of("cube", "M", Quantity::fem).empty());
  CHECK(gates.names_of("ball", "L").empty());
  const Json json = gates.to_json();
  CHECK(json[0]["met"] == true);
  CHECK(json[1]["met"] == false);
  CHECK(json[0]["asserts"] == "because");
}

TEST_CASE("a dossier of a case that was not solved says in every section what it lacks") {
  const TemporaryFolder folder;
  Answers answers;
  answers.fem.solution.status = cases::Status::failed;
  answers.fem.solution.message = "gave up";
  Dossier dossier;
  StudiedCase studied;
  studied.comparison =
      comparison_of(cases::make_scene(cases::read_case(folder.write("block.toml", block))), answers);
  dossier.cases.push_back(std::move(studied));
  const Json document = dossier_to_json(dossier);
  for (const char* section :
       {"context", "code_verification", "calculation_verification", "validation", "applicability"}) {
    INFO(section);
    const std::vector<Json> lacks = of_section(document, section);
    CHECK_FALSE(lacks.empty());
    for (const Json& one : lacks) {
      CHECK_FALSE(one["what"].get<std::string>().empty());
      CHECK_FALSE(one["filled_by"].get<std::string>().empty());
    }
  }
  CHECK(document["calculation_verification"][0]["measures"][0]["gates"]["fem"].empty());
  CHECK(document["context"]["question"].is_null());
  CHECK_FALSE(document["is_sound"].get<bool>());
  std::ostringstream text;
  write_dossier_text(text, document);
  CHECK_THAT(text.str(),
             Contains("missing: block: a measurement of the body, with its uncertainty. Filled by "
                      "--measured"));
}

TEST_CASE("the context of a dossier holds tools, and what materials add to their elasticity") {
  const TemporaryFolder folder;
  StudiedCase studied;
  studied.comparison =
      comparison_of(cases::make_scene(cases::read_case(folder.write("block.toml", block))), {});
  cases::Case& definition = studied.comparison.scene.definition;
  definition.material_dynamics = {1000, 2, 0.001, {{0.3, 0.1, 5}}};
  cases::Tool ball{"ball", cases::tools::Sphere{4}}, pin{"pin", cases::tools::Punch{2}};
  ball.at = {5, 5, 14};
  ball.displacement = {0, 0, -1};
  ball.friction = 0.25;
  pin.path = {{0, 5, 5, 11}, {0.5, 5, 5, 9}};
  definition.tools = {ball, pin};
  Dossier dossier;
  dossier.cases.push_back(std::move(studied));
  GateList gates("");
  MissingList missing;
  const Json context = context_to_json(dossier, gates, missing)["cases"][0];
  const Json& material = context["materials"].at(0);
  CHECK(material["youngs_modulus"] == 1);
  CHECK(material["density"] == 1000);
  CHECK(material["mass_damping"] == 2);
  CHECK(material["stiffness_damping"] == 0.001);
  CHECK(material["prony"] == Json::array({{{"g", 0.3}, {"k", 0.1}, {"tau", 5.}}}));
  REQUIRE(context["tools"].size() == 2);
  CHECK(context["tools"][0] == Json{{"name", "ball"},
                                    {"shape", "sphere"},
                                    {"at_mm", {5., 5., 14.}},
                                    {"displacement_mm", {0., 0., -1.}},
                                    {"path", nullptr},
                                    {"friction", 0.25}});
  CHECK(context["tools"][1]["path"][1] == Json::array({0.5, 5., 5., 9.}));
  CHECK(context["tools"][1]["displacement_mm"].is_null());
}

TEST_CASE("a dossier's displacement gradient is the largest of a motion's, which ends as it began") {
  const TemporaryFolder folder;
  StudiedCase studied;
  studied.comparison =
      comparison_of(cases::make_scene(cases::read_case(folder.write("block.toml", block))), {});
  cases::Solution& solution = studied.comparison.answers.fem.solution;
  const auto& nodes = studied.comparison.scene.mesh.nodes;
  solution.status = cases::Status::converged;
  solution.displacement.assign(nodes.size(), Eigen::Vector3d::Zero());
  std::vector<Eigen::Vector3d> stretched;
  for (std::size_t n = 0; n < nodes.size(); ++n) stretched.emplace_back(0, 0, 0.4 * nodes[n][2]);
  solution.trajectory = cases::Trajectory{};
  solution.trajectory->bodies = {{0, solution.displacement}, {1, stretched}, {2, solution.displacement}};
  MissingList missing;
  const Json json = applicability_to_json(studied, {}, missing);
  CHECK(json["fem"]["largest_gradient"].get<double>() == Approx(0.4));
}

TEST_CASE("a dossier refuses keys and data without a meaning before anything is solved") {
  const TemporaryFolder folder;
  DossierRequest request;
  request.cases.files = {folder.write("block.toml", block)};
  const auto refused = [&](const std::string& message) {
    CHECK_THROWS_WITH(make_dossier(request, never, never), Contains(message));
  };
  request.uncertain = {"material.youngs_modulus"};
  refused("--uncertain: is \"material.youngs_modulus\", must be KEY=SIGMA");
  request.uncertain = {"material.youngs_modulus=0"};
  refused("standard uncertainty > 0");
  request.uncertain = {"material.density=0.1"};
  refused("--uncertain: material.density: ");
  request.uncertain = {"material.youngs_modulus=0.01", "material.youngs_modulus=0.01"};
  refused("--uncertain: material.youngs_modulus: is there twice");
  request.uncertain = {};
  request.measured = folder.write("data.csv", "middle\n1\n");
  refused("data.csv:1: \"middle\" is no column");
}

TEST_CASE("a dossier refuses an uncertain key with an end that a case does not take, before any solve") {
  const TemporaryFolder folder;
  DossierRequest request;
  request.cases.files = {folder.write("block.toml", case_text::replaced(block, "= 0.3 }", "= 0.45 }"))};
  const auto refused = [&](const std::string& key, const std::string& says) {
    request.uncertain = {key};
    CHECK_THROWS_WITH(make_dossier(request, never, never),
                      Contains("--uncertain: material.") && Contains(says));
  };
  refused("material.poissons_ratio=0.06",
          "material.poissons_ratio: is 0.45 with the standard uncertainty 0.06, and");
  refused("material.poissons_ratio=0.06", "does not take 0.51 (");
  refused("material.youngs_modulus=1", "does not take 0 ("); // the lower end
  request.measured =
      folder.write("data.csv", "material.poissons_ratio,end\n0.48,0.1\n"); // another state's end
  refused("material.poissons_ratio=0.03", "material.poissons_ratio: is 0.48 with");
  request.uncertain = {"material.poissons_ratio=0.01"};
  CHECK_THROWS_WITH(make_dossier(request, never, never), Contains("nothing is to be solved")); // all is read
}

TEST_CASE("a dossier refuses a measured surface, which it would compare with nothing") {
  const TemporaryFolder folder;
  DossierRequest request;
  request.cases.files = {folder.write("block.toml", block)};
  folder.write("scan.obj", "v 0 0 10\nv 10 0 10\nv 0 10 10\nf 1 2 3\n");
  for (const char* data : {"surface\nscan.obj\n", "end,surface\n0.1,scan.obj\n"}) {
    request.measured = folder.write("data.csv", data);
    CHECK_THROWS_WITH(make_dossier(request, never, never),
                      Contains("data.csv: surface: is no datum of a dossier, must be a measure or a marker"));
  }
}

TEST_CASE("both models converge in their order on a column under its weight", "[verification][long]") {
  const std::string folder = cases::data_folder("cases") + "/verification/";
  const AnswerQuestions answer = [](const std::vector<Question>& questions) {
    std::vector<Answers> answers;
    for (const Question& question : questions)
      answers.push_back(solve(question.scene, question.request, solve_fem));
    return answers;
  };
  const CodeVerification code = verify_code({folder + "confined_column.toml", folder + "patch.toml"}, answer);
  CHECK(all_met(code.cases));
  std::size_t n_springs = 0;
  for (const ObservedOrder& one : code.orders) {
    INFO(one.model << ", " << one.measure << ": " << one.reason);
    REQUIRE(one.order);
    CHECK(*one.order == Approx(2).margin(0.02)); // the next term of the error is of order 4: 1/64 of it here
    if (one.model == "springs") ++n_springs;
  }
  CHECK(n_springs == 2);
  CHECK(code.orders.size() == 4);
}
