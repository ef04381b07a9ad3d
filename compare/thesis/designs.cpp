#include "compare/thesis/regenerate.hpp"

#include "cases/case/names.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <set>
#include <tuple>

namespace springproof::compare {

namespace {

void add(DesignRow& row, const PublishedFigure& figure, const std::optional<double>& error,
         const std::string& reason, const Trace& trace) {
  if (!error) {
    ++row.n_missing;
    if (std::find(row.reasons.begin(), row.reasons.end(), reason) == row.reasons.end())
      row.reasons.push_back(reason);
  } else if (row.errors.add(*error)) {
    row.worst_trace = trace;
    row.worst_at = fmt::format("{}{}{} {}", figure.load_set, figure.load_set.empty() ? "" : " ", figure.test,
                               figure.measure);
    if (figure.material != "ogden") row.worst_at += fmt::format(" nu = {:g}", figure.poissons_ratio);
  }
}

void add_computed(DesignRow& row, const PublishedFigure& figure, const Solutions& solutions,
                  const JobPair& jobs) {
  const MeasuredPair pair = measured_pair(solutions, jobs, figure.measure);
  add(row, figure, pair.error(), pair.reason, trace_of(jobs));
}

/// A published volume errs as much as it differs from the rest volume: the thesis compares it with nothing
/// else.
double published_error(const PublishedFigure& figure, const Comparison& fem) {
  return figure.unit == "%" ? figure.value : (figure.value / volumes_of(fem).rest - 1) * 100;
}

/// The linear method is in the tables as the thesis's own.
std::vector<std::string> other_designs() {
  std::vector<std::string> designs;
  for (const cases::Design design : msm::methods(cases::LinearElastic{}))
    if (design != cases::Design::linear_method) designs.push_back(cases::name_of(design));
  return designs;
}

/// The case file's material and cell, which the stiffnesses are made independent of.
msm::CellStiffness over_modulus_and_edge(const msm::CellStiffness& k, const cases::Scene& scene) {
  const double youngs_modulus = std::get<cases::LinearElastic>(scene.definition.material).youngs_modulus;
  const double scale = youngs_modulus * msm::cube_edge(cases::cell_vertices(scene.mesh, 0));
  return {k.edge / scale, k.face_diagonal / scale, k.internal_diagonal / scale, k.volume / youngs_modulus,
          k.exponents};
}

Advice advise_on(const AdviceQuestion& asked, const Solutions& solutions) {
  const std::vector<JobPair> jobs = advice_jobs(asked);
  std::vector<Comparison> tests;
  for (const auto& [fem, msm] : jobs) // springs that the material refuses have no scene
    tests.push_back(
        compare_sides(solutions.at(fem).scene, solutions.at(fem).answers, solutions.at(msm).answers));
  Advice advice{asked.poissons_ratio, asked.design};
  const auto& design = tests.front().answers.design;
  advice.is_designed = design.has_value();
  if (design && design->springs.cells())
    advice.stiffness = over_modulus_and_edge(design->stiffness, tests.front().scene);
  advice.cube = cube_errors(tests);
  std::vector<double> fem_seconds, msm_seconds;
  for (const Comparison& test : tests) {
    if (test.answers.fem.converged()) fem_seconds.push_back(test.answers.fem.seconds());
    if (test.answers.msm.converged()) msm_seconds.push_back(test.answers.msm.seconds());
  }
  advice.fem_seconds = median(fem_seconds).value_or(0);
  advice.msm_seconds = median(msm_seconds).value_or(0);
  const auto trace_of_worst = [&](const LoadSetErrors& errors) {
    return errors.worst ? trace_of(jobs[errors.worst_test]) : Trace{};
  };
  advice.small_trace = trace_of_worst(advice.cube.small);
  advice.large_trace = trace_of_worst(advice.cube.large);
  // With E = 1 MPa and a cell of 1 mm, the stiffnesses in N/m are a thousand times those over E L0.
  advice.trace.command = shell_command({"design", "--young", "1", "--poisson",
                                        fmt::format("{}", asked.poissons_ratio), "--method", asked.design});
  return advice;
}

} // namespace

std::vector<JobPair> design_jobs(const PublishedFigure& figure) {
  std::vector<JobPair> jobs;
  for (const std::string& design : other_designs()) jobs.push_back(designed_jobs(figure, design));
  return jobs;
}

std::vector<DesignRow> design_rows(const std::vector<PublishedFigure>& figures, const Solutions& solutions) {
  std::vector<DesignRow> rows;
  const auto row_of = [&](const std::string& table, const std::string& design) -> DesignRow& {
    const auto found = std::find_if(rows.begin(), rows.end(), [&](const DesignRow& row) {
      return row.table == table && row.design == design;
    });
    return found == rows.end() ? rows.emplace_back(DesignRow{table, design}) : *found;
  };
  for (const std::string& table : tables_of(figures)) {
    std::vector<PublishedFigure> questions; // the figures without regard to the thesis's springs
    std::set<std::tuple<double, std::string, std::string, std::string>> seen;
    for (const PublishedFigure& figure : figures) {
      if (figure.table != table || figure.test == "cell") continue;
      const JobPair jobs = thesis_jobs(figure);
      const double error = published_error(figure, solutions.at(jobs.fem));
      add(row_of(table, figure.design + ", in print"), figure, error, "", {});
      add_computed(row_of(table, figure.design + ", the thesis's set"), figure, solutions, jobs);
      if (seen.emplace(figure.poissons_ratio, figure.load_set, figure.test, figure.measure).second)
        questions.push_back(figure);
    }
    for (const PublishedFigure& figure : questions)
      for (const std::string& design : other_designs())
        add_computed(row_of(table, design), figure, solutions, designed_jobs(figure, design));
  }
  return rows;
}

void recommend(std::vector<Advice>& advice) {
  for (Advice& candidate : advice) {
    std::vector<Standing> rivals;
    for (const Advice& other : advice)
      rivals.push_back(other.poissons_ratio == candidate.poissons_ratio ? other.cube.standing() : Standing{});
    const auto found = recommended_of(rivals);
    candidate.is_recommended = found && &advice[*found] == &candidate;
  }
}

std::vector<AdviceQuestion> advice_questions() {
  std::vector<AdviceQuestion> questions;
  for (const double nu : {0.2, 0.3, 0.35, 0.45, 0.49})
    for (const cases::Design method : msm::methods(cases::LinearElastic{}))
      questions.push_back({nu, cases::name_of(method)});
  return questions;
}

std::vector<JobPair> advice_jobs(const AdviceQuestion& asked) {
  const auto& [nu, design] = asked;
  std::vector<JobPair> jobs;
  for (const CubeTest& test : cube_tests)
    jobs.push_back(
        designed_jobs({"", "linear_elastic", nu, design, nu, test.load_set, test.test, "", "%", 0}, design));
  return jobs;
}

std::vector<Advice> advise(const std::vector<AdviceQuestion>& questions, const Solutions& solutions) {
  std::vector<Advice> advice;
  for (const AdviceQuestion& asked : questions) advice.push_back(advise_on(asked, solutions));
  recommend(advice);
  return advice;
}

} // namespace springproof::compare
