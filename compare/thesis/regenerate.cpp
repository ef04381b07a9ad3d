#include "compare/thesis/regenerate.hpp"

#include "cases/case/names.hpp"
#include "cases/case/read_case.hpp"
#include "compare/provenance/machine.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <numeric>
#include <set>
#include <tuple>

namespace springproof::compare {

namespace {

/// The figures of the tables asked for, or of all.  @throws InputError for an unknown table
std::vector<PublishedFigure> figures_of(const std::vector<std::string>& wanted) {
  const auto has = [](const std::vector<std::string>& tables, const std::string& table) {
    return std::find(tables.begin(), tables.end(), table) != tables.end();
  };
  const std::vector<std::string> known = tables_of(published_figures());
  for (const std::string& table : wanted)
    if (!has(known, table))
      throw cases::InputError(
          fmt::format("table '{}' is not known; there are {}{}", table, fmt::join(known, ", "),
                      table == "4.4" ? " (4.4 lists the loads, which the case files hold)" : ""));
  std::vector<PublishedFigure> figures;
  for (const PublishedFigure& figure : published_figures())
    if (wanted.empty() || has(wanted, figure.table)) figures.push_back(figure);
  return figures;
}

/// Every solve that the tables need, once.
std::vector<SolveJob> jobs_for(const std::vector<PublishedFigure>& figures, bool is_everything) {
  std::set<SolveJob> jobs;
  const auto add = [&](const std::vector<JobPair>& pairs) {
    for (const JobPair& pair : pairs) jobs.insert({pair.fem, pair.msm});
  };
  for (const PublishedFigure& figure : figures) {
    if (figure.test == "cell") continue;
    add(entry_jobs(figure));
    if (is_everything) add(design_jobs(figure));
  }
  if (is_everything)
    for (const AdviceQuestion& asked : advice_questions()) add(advice_jobs(asked));
  return {jobs.begin(), jobs.end()};
}

/// The jobs of every case that is behind figures of a kind, once: the first set of springs that the thesis
/// has for it stands for the case.
template<class IsWanted>
std::vector<JobPair> jobs_of_cases(const std::vector<PublishedFigure>& figures, const IsWanted& is_wanted) {
  std::set<std::string> seen;
  std::vector<JobPair> jobs;
  for (const PublishedFigure& figure : figures)
    if (figure.test != "cell" && is_wanted(figure) && seen.insert(case_file_of(figure)).second)
      jobs.push_back(thesis_jobs(figure));
  return jobs;
}

/// Whether the figure is of the case file's own material, not of the file with another Poisson's ratio set.
bool has_own_poissons_ratio(const PublishedFigure& figure) {
  const cases::Case definition = cases::read_case(cases_folder() + "/" + case_file_of(figure));
  const auto* elastic = std::get_if<cases::LinearElastic>(&definition.material);
  return !elastic || elastic->poissons_ratio == figure.poissons_ratio;
}

ThesisResults tables_from(const std::vector<PublishedFigure>& figures, bool is_everything,
                          const Solutions& solutions) {
  ThesisResults results;
  results.cells = analyse_cells(figures);
  results.entries = cell_entries(figures, results.cells);
  const std::vector<TableEntry> errors = error_entries(figures, solutions);
  results.entries.insert(results.entries.end(), errors.begin(), errors.end());
  explain(results.entries);
  for (const JobPair& jobs : jobs_of_cases(figures, has_own_poissons_ratio)) {
    results.cases.push_back(join(solutions, jobs));
    results.volumes.push_back(volumes_of(results.cases.back(), trace_of(jobs)));
  }
  const auto is_of_figure_4_15 = [](const PublishedFigure& figure) { // solved for these tables anyway
    return (figure.table == "4.5" || figure.table == "4.6") && figure.poissons_ratio == 0.25;
  };
  for (const JobPair& jobs : jobs_of_cases(figures, is_of_figure_4_15))
    results.figure_4_15.push_back(join(solutions, jobs));
  results.cell_volume_changes = cell_volume_changes(figures, solutions);
  if (is_everything) {
    results.designs = design_rows(figures, solutions);
    results.advice = advise(advice_questions(), solutions);
  }
  return results;
}

/// Summed over all solves of one side.
double seconds(const Solutions& solutions, cases::Side side) {
  double sum = 0;
  for (const auto& [job, comparison] : solutions)
    for (const Answer* solved : {&comparison.answers.fem, &comparison.answers.msm})
      if (job.only == side) sum += solved->setup_seconds + solved->solve_seconds;
  return sum;
}

double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

std::optional<ModelVolumes> volumes_of(const cases::Solution& solution) {
  if (solution.status != cases::Status::converged) return std::nullopt;
  return ModelVolumes{sum(solution.cell_volume), box_plot(solution.cell_volume)};
}

/// Outermost whisker's distance from the rest volume, percent.
std::optional<double> largest_change(const CaseVolumes& volumes) {
  if (!volumes.msm) return std::nullopt;
  const double low = volumes.rest_per_cell - volumes.msm->per_cell.lower_whisker;
  const double high = volumes.msm->per_cell.upper_whisker - volumes.rest_per_cell;
  return std::max(low, high) / volumes.rest_per_cell * 100;
}

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
  msm::CellStiffness unit = scaled(k, 1 / scale);
  unit.volume = k.volume / youngs_modulus;
  return unit;
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

std::vector<SolveJob> jobs_of_tables(const std::vector<std::string>& tables) {
  return jobs_for(figures_of(tables), tables.empty());
}

ThesisResults regenerate(const std::vector<std::string>& tables, const AnswerQuestions& answer,
                         const std::string& workers) {
  const std::vector<PublishedFigure> figures = figures_of(tables);
  Stopwatch stopwatch;
  const std::vector<SolveJob> jobs = jobs_of_tables(tables);
  const double collecting = stopwatch.lap();
  std::vector<Solved> solved = solve_jobs(jobs, answer);
  const double solving = stopwatch.lap();
  Solutions solutions;
  for (std::size_t j = 0; j < jobs.size(); ++j)
    solutions[jobs[j]] = comparison_of(std::move(solved[j].scene), std::move(solved[j].answers));
  ThesisResults results = tables_from(figures, tables.empty(), solutions);
  results.workers = workers;
  results.times = {{fmt::format("{} solves, workers: {}", jobs.size(), workers), solving},
                   {"  of which finite elements, all workers", seconds(solutions, cases::Side::fem)},
                   {"  of which springs, all workers", seconds(solutions, cases::Side::msm)},
                   {"tables", collecting + stopwatch.lap()}};
  return results;
}

CaseVolumes volumes_of(const Comparison& comparison, const Trace& trace) {
  const cases::Mesh& mesh = comparison.scene.mesh;
  std::vector<double> rest;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    rest.push_back(cases::cell_volume(cases::cell_corners(mesh, c)));
  return {comparison.scene.definition.name,
          sum(rest),
          sum(rest) / static_cast<double>(rest.size()),
          volumes_of(comparison.answers.fem.solution),
          volumes_of(comparison.answers.msm.solution),
          trace};
}

std::vector<CellVolumeChange> cell_volume_changes(const std::vector<PublishedFigure>& figures,
                                                  const Solutions& solutions) {
  std::vector<CellVolumeChange> changes;
  for (const char* load_set : {"small", "large"}) {
    std::vector<std::optional<double>> of_tests;
    for (const PublishedFigure& figure : figures)
      if (figure.table == "5.2" && figure.load_set == load_set)
        of_tests.push_back(largest_change(volumes_of(solutions.at(thesis_jobs(figure).msm))));
    if (of_tests.empty()) continue;
    const bool is_whole = std::count(of_tests.begin(), of_tests.end(), std::nullopt) == 0;
    changes.push_back({load_set, published_cell_volume_change(load_set),
                       is_whole ? *std::max_element(of_tests.begin(), of_tests.end()) : std::nullopt});
  }
  return changes;
}

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
