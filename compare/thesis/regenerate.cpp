#include "compare/thesis/regenerate.hpp"

#include "compare/provenance/stopwatch.hpp"
#include "compare/thesis/build_results.hpp"

#include <algorithm>
#include <fmt/format.h>

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

/// All that stands on solves. Called twice: see SolveSet.
ThesisResults build(const std::vector<PublishedFigure>& figures, bool is_everything, SolveSet& solves) {
  ThesisResults results;
  results.entries = error_entries(figures, solves);
  add_cases(figures, solves, results);
  results.cell_volume_changes = cell_volume_changes(figures, solves);
  if (is_everything) {
    results.designs = design_rows(figures, solves);
    results.advice = advise(solves);
  }
  return results;
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
  SolveSet solves;
  build(figures, is_everything, solves);
  const double collecting = stopwatch.lap();
  solves.solve(options, progress);
  const double solving = stopwatch.lap();
  ThesisResults results = build(figures, is_everything, solves);
  results.cells = analyse_cells(figures);
  std::vector<TableEntry> cells = cell_entries(figures, results.cells);
  results.entries.insert(results.entries.begin(), cells.begin(), cells.end());
  explain(results.entries);
  results.n_workers = options.n_workers > 0 ? options.n_workers : cores();
  results.times = {{fmt::format("{} solves on {} workers", solves.size(), results.n_workers), solving},
                   {"  of which finite elements, all workers", solves.seconds(cases::Side::fem)},
                   {"  of which springs, all workers", solves.seconds(cases::Side::msm)},
                   {"tables", collecting + stopwatch.lap()}};
  return results;
}

} // namespace springproof::compare
