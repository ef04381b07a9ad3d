#pragma once

#include "compare/solve/solve_jobs.hpp"
#include "compare/thesis/cells.hpp"
#include "compare/thesis/designs.hpp"
#include "compare/thesis/volumes.hpp"

namespace springproof::compare {

struct PhaseTime {
  std::string phase;
  double seconds;
};

/// What `springproof tables` knows when everything is solved: plain records, which the writers and the report
/// read. Nothing here is computed by a writer again.
struct ThesisResults {
  std::vector<TableEntry> entries; ///< one per published figure of the tables asked for
  /// Every thesis case once, both sides solved: declared reference, the thesis's stiffnesses, and the case
  /// file's own material. For drawings, volumes and fields.
  std::vector<Comparison> cases;
  std::vector<CaseVolumes> volumes; ///< one per case
  /// The cube of figure 4.15, nu = 0.25 with the printed set: the tests that the tables asked for have in
  /// common with it.
  std::vector<Comparison> figure_4_15;
  std::vector<CellAnalysis> cells;
  std::vector<CellVolumeChange> cell_volume_changes; ///< with table 5.2
  std::vector<DesignRow> designs;
  std::vector<Advice> advice;
  std::vector<PhaseTime> times; ///< differ from run to run, as the advice's seconds do
  std::string workers;          ///< "2", or "2 shards"
};

/// Every solve that the tables need, once.
/// @param tables  numbers; empty: all of them, and the comparison of designs and the advice, which look at
///                every table
/// @throws InputError for an unknown table
std::vector<SolveJob> jobs_of_tables(const std::vector<std::string>& tables);

/// Solves what the tables need, each solve once, and computes every number of ThesisResults.
/// @param answer   answers all questions   @param workers  who does: "2", or "2 shards"
/// @throws InputError for an unknown table
ThesisResults regenerate(const std::vector<std::string>& tables, const AnswerQuestions& answer,
                         const std::string& workers);

} // namespace springproof::compare
