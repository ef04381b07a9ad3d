#include "cases/case/read_case.hpp"
#include "compare/thesis/build_results.hpp"

#include <algorithm>
#include <numeric>
#include <set>

namespace springproof::compare {

namespace {

double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

ModelVolumes volumes_of(const cases::Solution& solution) {
  if (solution.status != cases::Status::converged) return {};
  return {sum(solution.cell_volume), box_plot(solution.cell_volume)};
}

/// The springs' case with the finite elements' answer put in.
Comparison join(const Solutions& solutions, const JobPair& jobs) {
  const Comparison &fem = solutions.at(jobs.fem), &msm = solutions.at(jobs.msm);
  Answers both = msm.answers;
  both.fem = fem.answers.fem;
  both.resolved = fem.answers.resolved;
  return comparison_of(msm.scene, both);
}

/// Whether the figure is of the case file's own material, not of the file with another Poisson's ratio set.
bool has_own_poissons_ratio(const PublishedFigure& figure, const std::string& case_file) {
  const cases::Case definition = cases::read_case(case_file);
  const auto* elastic = std::get_if<cases::LinearElastic>(&definition.material);
  return !elastic || elastic->poissons_ratio == figure.poissons_ratio;
}

/// Solved for tables 4.5 and 4.6 anyway.
void add_figure_4_15(const std::vector<PublishedFigure>& figures, const Solutions& solutions,
                     ThesisResults& results) {
  std::set<std::string> seen;
  for (const PublishedFigure& figure : figures) {
    if (figure.table != "4.5" && figure.table != "4.6") continue;
    if (figure.poissons_ratio == 0.25 && seen.insert(case_file_of(figure)).second)
      results.figure_4_15.push_back(join(solutions, thesis_jobs(figure)));
  }
}

/// Outermost whisker's distance from the rest volume, percent.
std::optional<double> largest_change(const CaseVolumes& volumes) {
  if (!volumes.msm.per_cell) return std::nullopt;
  const double low = volumes.rest_per_cell - volumes.msm.per_cell->lower_whisker;
  const double high = volumes.msm.per_cell->upper_whisker - volumes.rest_per_cell;
  return std::max(low, high) / volumes.rest_per_cell * 100;
}

} // namespace

CaseVolumes volumes_of(const Comparison& comparison) {
  const cases::HexMesh& mesh = comparison.scene.mesh;
  std::vector<double> rest;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    rest.push_back(cases::cell_volume(cases::cell_vertices(mesh, c)));
  return {comparison.scene.definition.name,
          sum(rest),
          sum(rest) / static_cast<double>(rest.size()),
          volumes_of(comparison.answers.fem.solution),
          volumes_of(comparison.answers.msm.solution),
          {}};
}

void add_cases(const std::vector<PublishedFigure>& figures, const Solutions& solutions,
               ThesisResults& results) {
  std::set<std::string> seen;
  for (const PublishedFigure& figure : figures) {
    if (figure.test == "cell") continue;
    const JobPair jobs = thesis_jobs(figure);
    // The first set of springs that the thesis has for the case file's own material stands for the case.
    if (!has_own_poissons_ratio(figure, jobs.fem.case_file)) continue;
    if (!seen.insert(jobs.fem.case_file).second) continue;
    results.cases.push_back(join(solutions, jobs));
    results.case_traces.push_back(trace_of(jobs));
    results.volumes.push_back(volumes_of(results.cases.back()));
    results.volumes.back().trace = results.case_traces.back();
  }
  add_figure_4_15(figures, solutions, results);
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
    const bool is_whole =
        std::all_of(of_tests.begin(), of_tests.end(), [](const auto& c) { return c.has_value(); });
    changes.push_back({load_set, published_cell_volume_change(load_set),
                       is_whole ? *std::max_element(of_tests.begin(), of_tests.end()) : std::nullopt});
  }
  return changes;
}

} // namespace springproof::compare
