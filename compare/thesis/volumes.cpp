#include "compare/thesis/volumes.hpp"

#include <algorithm>
#include <numeric>

namespace springproof::compare {

namespace {

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

} // namespace

CaseVolumes volumes_of(const Comparison& comparison, const Trace& trace) {
  const cases::HexMesh& mesh = comparison.scene.mesh;
  std::vector<double> rest;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    rest.push_back(cases::cell_volume(cases::cell_vertices(mesh, c)));
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

} // namespace springproof::compare
