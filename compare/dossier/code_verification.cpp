#include "cases/case/elements.hpp"
#include "cases/case/error.hpp"
#include "cases/case/input_file.hpp"
#include "cases/case/installation.hpp"
#include "compare/dossier/dossier.hpp"
#include "compare/error_bars/auto_fem.hpp"
#include "compare/peers/calculix.hpp"
#include "compare/peers/getfem.hpp"
#include "compare/provenance/whole_file.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <sstream>

namespace springproof::compare {

namespace {

/// Whether a case expects what others than this program say.
bool verifies(const cases::Case& definition) {
  using cases::ReferenceKind;
  const auto does = [](const cases::Expectation& expected) {
    return expected.reference == ReferenceKind::exact || expected.reference == ReferenceKind::converged ||
           expected.reference == ReferenceKind::peer;
  };
  return std::any_of(definition.expectations.begin(), definition.expectations.end(), does);
}

bool has_a_limit(const Comparison& comparison) {
  if (!comparison.mesh_study) return false;
  const auto& measures = comparison.mesh_study->measures;
  return std::any_of(measures.begin(), measures.end(), [](const auto& m) { return m.limit.has_value(); });
}

void add_orders_of_fem(const Comparison& comparison, std::vector<ObservedOrder>& orders) {
  for (const StudiedMeasure& studied : comparison.mesh_study->measures) {
    ObservedOrder found{comparison.scene.definition.name,
                        "finite elements",
                        studied.name,
                        find_named(comparison.measures, studied.name)->unit,
                        studied.values,
                        cases::facts_of(comparison.answers.resolved.element).order};
    if (studied.limit) found.order = studied.limit->order;
    found.reason = studied.reason;
    orders.push_back(std::move(found));
  }
}

/// The springs on lattices of 1, 1/2, 1/4 and 1/8 of the case's width.
void add_orders_of_springs(const Comparison& comparison, std::vector<ObservedOrder>& orders) {
  constexpr int n_lattices = 4;
  const std::vector<cases::Measure>& measures = comparison.scene.definition.measures;
  std::vector<ObservedOrder> found;
  for (const cases::Measure& measure : measures)
    found.push_back(
        {comparison.scene.definition.name, "springs", measure.name, unit_of(measure), {}, std::nullopt});
  std::string failure;
  cases::Scene scene = comparison.scene;
  for (int n = 0; n < n_lattices && failure.empty(); ++n) {
    if (n > 0) scene = finer_lattice(scene);
    const Answers answers = solve(scene, {cases::Side::msm}, solve_fem);
    if (!answers.msm.converged()) failure = answers.msm.solution.message;
    for (std::size_t m = 0; m < measures.size() && failure.empty(); ++m) {
      const auto value = finite_value(scene.definition.measures[m], scene, answers.msm.solution);
      if (const auto* reason = std::get_if<std::string>(&value))
        failure = *reason;
      else
        found[m].values.push_back(std::get<double>(value));
    }
  }
  for (ObservedOrder& one : found) {
    const MeshVerdict verdict = failure.empty() ? judge_refinement(one.values, 2) : MeshVerdict(failure);
    if (const auto* limit = std::get_if<MeshLimit>(&verdict))
      one.order = limit->order;
    else
      one.reason = std::get<std::string>(verdict);
    orders.push_back(std::move(one));
  }
}

std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields;
  std::string field;
  for (std::size_t i = 1; i < line.size(); ++i)
    if (line[i] == '|') {
      fields.emplace_back(cases::without_blanks(field));
      field.clear();
    } else if (line[i] != '`') {
      field += line[i];
    }
  return fields;
}

} // namespace

std::vector<ProjectTest> project_tests(const std::string& markdown) {
  std::vector<ProjectTest> tests;
  std::string part;
  bool is_in_table = false;
  std::istringstream in(markdown);
  for (std::string line; std::getline(in, line);) {
    if (line.rfind("## ", 0) == 0) part = line.substr(3);
    if (line.rfind("|", 0) != 0) {
      is_in_table = false;
      continue;
    }
    const std::vector<std::string> fields = fields_of(line);
    if (is_in_table && line.find_first_not_of("|- ") != std::string::npos && fields.size() >= 2)
      tests.push_back({part, fields[0], fields[1], fields.size() > 2 ? fields[2] : ""});
    if (!fields.empty() && fields.front() == "what is checked") is_in_table = true;
  }
  return tests;
}

CodeVerification verify_code(const std::vector<std::string>& files, const AnswerQuestions& answer) {
  constexpr int most_meshes = 3; // GetFEM takes seconds for the next one
  CodeVerification code;
  std::vector<Question> questions = read_questions(files, {}, {});
  questions.erase(std::remove_if(questions.begin(), questions.end(),
                                 [](const Question& q) { return !verifies(q.scene.definition); }),
                  questions.end());
  std::vector<Answers> answers = answer(questions);
  for (std::size_t q = 0; q < questions.size(); ++q) {
    cases::Scene& scene = questions[q].scene;
    if (!reason_without_calculix(with_fem(scene, answers[q].resolved).definition))
      answers[q].peer = ask_calculix(with_fem(scene, answers[q].resolved), answers[q].fem);
    Comparison comparison = comparison_of(std::move(scene), std::move(answers[q]));
    const bool has_limit = has_a_limit(comparison);
    if (has_limit) add_orders_of_fem(comparison, code.orders);
    if (has_limit && comparison.answers.msm.converged()) add_orders_of_springs(comparison, code.orders);
    if (has_limit && !reason_without_getfem(comparison.scene))
      code.second_codes.emplace_back(comparison.scene.definition.name,
                                     study_by_getfem(comparison, most_meshes));
    code.cases.push_back(std::move(comparison));
  }
  code.tests = project_tests(read_file(cases::data_folder("verification") + "/verification.md"));
  return code;
}

} // namespace springproof::compare
