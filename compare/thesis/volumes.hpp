#pragma once

#include "compare/measure/box_plot.hpp"
#include "compare/thesis/table_jobs.hpp"

/// Volumes of the deformed bodies and of their cells: figure 5.10 and thesis section 5.3.1.3.
namespace springproof::compare {

/// Volumes of one case in one model.
struct ModelVolumes {
  double total;     ///< mm³
  BoxPlot per_cell; ///< mm³, of the cells of the body's mesh
};

struct CaseVolumes {
  std::string name;                     ///< of the case
  double rest;                          ///< of the whole body, mm³
  double rest_per_cell;                 ///< mm³
  std::optional<ModelVolumes> fem, msm; ///< absent when it failed
  Trace trace{};                        ///< gives both bodies' volumes
};

CaseVolumes volumes_of(const Comparison& comparison, const Trace& trace = {});

/// Largest change of a cell's volume between the whiskers of figure 5.10, over the three tests of a load set.
struct CellVolumeChange {
  std::string load_set;
  double published;               ///< thesis section 5.3.1.3, percent of the rest volume
  std::optional<double> computed; ///< of the springs; absent if a test failed
};

/// Of the cases behind table 5.2; empty when that is not among the figures.
std::vector<CellVolumeChange> cell_volume_changes(const std::vector<PublishedFigure>& figures,
                                                  const Solutions& solutions);

} // namespace springproof::compare
