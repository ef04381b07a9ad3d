#include "compare/thesis/regenerate.hpp"

#include "compare/error_bars/auto_fem.hpp"
#include "compare/provenance/stopwatch.hpp"
#include "compare/thesis/build_results.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <set>

namespace springproof::compare {

namespace {

/// The figures of the tables asked for, in print's order.
std::vector<PublishedFigure> figures_of(const std::vector<std::string>& wanted) {
  const std::vector<PublishedFigure> all = read_published_figures();
  std::vector<PublishedFigure> figures;
  for (const std::string& table : known_tables())
    if (std::find(wanted.begin(), wanted.end(), table) != wanted.end())
      std::copy_if(all.begin(), all.end(), std::back_inserter(figures),
                   [&](const PublishedFigure& figure) { return figure.table == table; });
  return figures;
}

void check_known(const std::vector<std::string>& tables) {
  const std::vector<std::string> known = known_tables();
  for (const std::string& table : tables)
    if (std::find(known.begin(), known.end(), table) == known.end())
      throw cases::InputError(
          fmt::format("table '{}' is not known; there are {}{}", table, fmt::join(known, ", "),
                      table == "4.4" ? " (4.4 lists the loads, which the case files hold)" : ""));
}

/// Every solve that the tables need, once.
std::vector<SolveJob> jobs_for(const std::vector<PublishedFigure>& figures, bool is_everything) {
  std::set<SolveJob> jobs;
  const auto add = [&](const std::vector<SolveJob>& more) { jobs.insert(more.begin(), more.end()); };
  for (const PublishedFigure& figure : figures) {
    if (figure.test == "cell") continue;
    add(entry_jobs(figure));
    if (is_everything) add(design_jobs(figure));
  }
  if (!is_everything) return {jobs.begin(), jobs.end()};
  for (const AdviceQuestion& asked : advice_questions()) add(advice_jobs(asked));
  return {jobs.begin(), jobs.end()};
}

ThesisResults tables_from(const std::vector<PublishedFigure>& figures, bool is_everything,
                          const Solutions& solutions) {
  ThesisResults results;
  results.cells = analyse_cells(figures);
  results.entries = cell_entries(figures, results.cells);
  const std::vector<TableEntry> errors = error_entries(figures, solutions);
  results.entries.insert(results.entries.end(), errors.begin(), errors.end());
  explain(results.entries);
  add_cases(figures, solutions, results);
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
  for (const auto& [job, comparison] : solutions) {
    if (job.only != side) continue;
    const Answer& solved = side == cases::Side::fem ? comparison.answers.fem : comparison.answers.msm;
    sum += solved.setup_seconds + solved.solve_seconds;
  }
  return sum;
}

} // namespace

std::vector<std::string> known_tables() {
  std::vector<std::string> numbers;
  for (const PublishedFigure& figure : read_published_figures())
    if (std::find(numbers.begin(), numbers.end(), figure.table) == numbers.end())
      numbers.push_back(figure.table);
  std::stable_sort(numbers.begin(), numbers.end(), [](const std::string& a, const std::string& b) {
    return std::pair(a.size(), a) < std::pair(b.size(), b); // 5.12 after 5.4
  });
  return numbers;
}

ThesisResults regenerate(const std::vector<std::string>& tables, const SolveOptions& options,
                         const std::function<void(int done, int all)>& progress) {
  check_known(tables);
  const bool is_everything = tables.empty();
  const std::vector<PublishedFigure> figures = figures_of(is_everything ? known_tables() : tables);
  Stopwatch stopwatch;
  const std::vector<SolveJob> jobs = jobs_for(figures, is_everything);
  const double collecting = stopwatch.lap();
  std::vector<Solved> solved = solve_jobs(jobs, solve_fem, options, progress);
  const double solving = stopwatch.lap();
  Solutions solutions;
  for (std::size_t j = 0; j < jobs.size(); ++j)
    solutions[jobs[j]] = comparison_of(std::move(solved[j].scene), std::move(solved[j].answers));
  ThesisResults results = tables_from(figures, is_everything, solutions);
  results.n_workers = options.n_workers > 0 ? options.n_workers : cores();
  results.times = {{fmt::format("{} solves on {} workers", jobs.size(), results.n_workers), solving},
                   {"  of which finite elements, all workers", seconds(solutions, cases::Side::fem)},
                   {"  of which springs, all workers", seconds(solutions, cases::Side::msm)},
                   {"tables", collecting + stopwatch.lap()}};
  return results;
}

} // namespace springproof::compare
