#pragma once

#include "compare/thesis/results.hpp"
#include "compare/thesis/table_jobs.hpp"

#include <vector>

/// The parts of ThesisResults, a function each. Those that take a SolveSet say what they need when they are
/// called before its solve(), and give their answer when they are called after it.
namespace springproof::compare {

/// One entry per published figure of tables 4.5 to 5.4 and figure 5.12, against each reference.
std::vector<TableEntry> error_entries(const std::vector<PublishedFigure>& figures, SolveSet& solves);

/// Tables 4.1 to 4.3: the cells of these Poisson's ratios (ascending, each once) ...
std::vector<CellAnalysis> analyse_cells(const std::vector<PublishedFigure>& figures);
/// ... and one entry per published figure of a cell.
std::vector<TableEntry> cell_entries(const std::vector<PublishedFigure>& figures,
                                     const std::vector<CellAnalysis>& cells);

/// Every case behind the figures once, with the case file's own Poisson's ratio.
void add_cases(const std::vector<PublishedFigure>& figures, SolveSet& solves, ThesisResults& results);

/// Total and per-cell volumes of both models.
CaseVolumes volumes_of(const Comparison& comparison);

/// Of the cases behind table 5.2; empty when that is not among the figures.
std::vector<CellVolumeChange> cell_volume_changes(const std::vector<PublishedFigure>& figures,
                                                  SolveSet& solves);

/// Per table: the figures in print, the thesis's sets, and the methods nonlinear_method (true minimiser of
/// eq. 5.9), moduli, hybrid and multi_load, each designed from the table's own material.
std::vector<DesignRow> design_rows(const std::vector<PublishedFigure>& figures, SolveSet& solves);

/// Every design method for linear elasticity at nu = 0.2, 0.3, 0.35, 0.45, 0.49 on the thesis's cube.
std::vector<Advice> advise(SolveSet& solves);

/// Marks, for each Poisson's ratio, the design with the smallest worst error over both load sets, among those
/// that are stable in every test; none when there is none.
void recommend(std::vector<Advice>& advice);

/// What is known of printed figures that no computation meets, into the entries' `finding`.
void explain(std::vector<TableEntry>& entries);

} // namespace springproof::compare
