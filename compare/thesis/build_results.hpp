#pragma once

#include "compare/thesis/results.hpp"
#include "compare/thesis/table_jobs.hpp"

#include <vector>

/// The parts of ThesisResults, a function each: the jobs of a part where no other part has them, and what
/// their solutions say.
namespace springproof::compare {

std::vector<SolveJob> entry_jobs(const PublishedFigure& figure);
/// One entry per published figure of tables 4.5 to 5.4 and figure 5.12, against each reference.
std::vector<TableEntry> error_entries(const std::vector<PublishedFigure>& figures,
                                      const Solutions& solutions);

/// Tables 4.1 to 4.3: the cells of these Poisson's ratios (ascending, each once) ...
std::vector<CellAnalysis> analyse_cells(const std::vector<PublishedFigure>& figures);
/// ... and one entry per published figure of a cell.
std::vector<TableEntry> cell_entries(const std::vector<PublishedFigure>& figures,
                                     const std::vector<CellAnalysis>& cells);

/// Every case behind the figures once, with the case file's own Poisson's ratio.
void add_cases(const std::vector<PublishedFigure>& figures, const Solutions& solutions,
               ThesisResults& results);

/// Total and per-cell volumes of both models.
CaseVolumes volumes_of(const Comparison& comparison);

/// Of the cases behind table 5.2; empty when that is not among the figures.
std::vector<CellVolumeChange> cell_volume_changes(const std::vector<PublishedFigure>& figures,
                                                  const Solutions& solutions);

std::vector<SolveJob> design_jobs(const PublishedFigure& figure);
/// Per table: the published figures, the thesis's sets, and every method but the linear one
/// (nonlinear_method: the true minimiser of eq. 5.9), each designed from the table's own material.
std::vector<DesignRow> design_rows(const std::vector<PublishedFigure>& figures, const Solutions& solutions);

/// A design for linear elasticity at a Poisson's ratio, to be measured on the cube.
struct AdviceQuestion {
  double poissons_ratio;
  std::string design;
};
/// Every method at nu = 0.2, 0.3, 0.35, 0.45, 0.49.
std::vector<AdviceQuestion> advice_questions();
std::vector<SolveJob> advice_jobs(const AdviceQuestion& asked);
std::vector<Advice> advise(const std::vector<AdviceQuestion>& questions, const Solutions& solutions);

/// Marks, for each Poisson's ratio, the design with the smallest worst error over both load sets, among those
/// that are stable in every test; none when there is none.
void recommend(std::vector<Advice>& advice);

/// What is known of printed figures that no computation meets, into the entries' `finding`.
void explain(std::vector<TableEntry>& entries);

} // namespace springproof::compare
