#pragma once

#include "compare/measure/box_plot.hpp"
#include "compare/solve/solve_jobs.hpp"
#include "compare/thesis/entries.hpp"
#include "compare/thesis/published.hpp"

/// What `springproof tables` knows when everything is solved: entries, volumes, and what other designs than
/// the thesis's give, in its tables and as advice for linear elasticity.
namespace springproof::compare {

/// One table with springs of one design: what the error is, whatever print says. Errors against the table's
/// declared reference; volumes count as errors against the finite elements' volume.
struct DesignRow {
  std::string table;
  std::string design;                 ///< "DESIGN, in print", "DESIGN, the thesis's set", or a method's name
  WorstError errors{};                ///< percent, of the figures that have a value
  int n_missing = 0;                  ///< refused or failed
  std::string worst_at{};             ///< "large shear alpha_1 nu = 0.49"
  std::vector<std::string> reasons{}; ///< why figures are missing, each once
  Trace worst_trace{};                ///< gives the worst figure
};

/// The jobs behind a published figure's part in the rows.
std::vector<JobPair> design_jobs(const PublishedFigure& figure);

/// Rows of every table: the published figures, the thesis's sets, and every method but the linear one
/// (nonlinear_method: the true minimiser of eq. 5.9), each designed from the table's own material.
std::vector<DesignRow> design_rows(const std::vector<PublishedFigure>& figures, const Solutions& solutions);

/// A design for linear elasticity at a Poisson's ratio, to be measured on the cube.
struct AdviceQuestion {
  double poissons_ratio;
  std::string design;
};

/// Every method at nu = 0.2, 0.3, 0.35, 0.45, 0.49.
std::vector<AdviceQuestion> advice_questions();

/// The jobs of a question, in the order of cube_tests.
std::vector<JobPair> advice_jobs(const AdviceQuestion& asked);

/// A design at one Poisson's ratio, for any Young's modulus E and edge L0, with its errors on the thesis's
/// cube. The errors hold for equal strains, that is equal force/(E L0²).
struct Advice {
  double poissons_ratio;
  std::string design;
  std::optional<msm::CellStiffness> stiffness{}; ///< over E L0 (volume: over E), no unit; absent when
                                                 ///< refused, and where the cells are not of four stiffnesses
  bool is_designed = false;                      ///< not refused
  CubeErrors cube{};
  /// Medians of the six tests that converged: setup and solve; 0 without any. They differ from run to run.
  double fem_seconds = 0, msm_seconds = 0;
  Trace small_trace{}, large_trace{}; ///< give the worst error under either load set
  bool is_recommended = false;        ///< one at most for each Poisson's ratio
  Trace trace{};                      ///< gives the stiffnesses
  /// Why there are no stiffnesses or errors; empty otherwise.
  const std::string& refusal() const {
    return cube.small.failure.empty() ? cube.large.failure : cube.small.failure;
  }
};

std::vector<Advice> advise(const std::vector<AdviceQuestion>& questions, const Solutions& solutions);

/// Marks, for each Poisson's ratio, the design with the smallest worst error over both load sets, among those
/// that are stable in every test; none when there is none.
void recommend(std::vector<Advice>& advice);

/// Volumes of one case in one model.
struct ModelVolumes {
  double total;     ///< mm³
  BoxPlot per_cell; ///< mm³, of the cells of the body's mesh
};

struct CaseVolumes {
  std::string name;                     ///< the case's
  double rest;                          ///< the whole body's, mm³
  double rest_per_cell;                 ///< mm³
  std::optional<ModelVolumes> fem, msm; ///< absent when it failed
  Trace trace{};                        ///< gives both bodies' volumes
};

CaseVolumes volumes_of(const Comparison& comparison, const Trace& trace = {});

/// Largest change of a cell's volume between the whiskers of figure 5.10, over the three tests of a load set.
struct CellVolumeChange {
  std::string load_set;
  double published;               ///< thesis section 5.3.1.3, percent of the rest volume
  std::optional<double> computed; ///< the springs'; absent if a test failed
};

/// Changes in the cases behind table 5.2; empty when that is not among the figures.
std::vector<CellVolumeChange> cell_volume_changes(const std::vector<PublishedFigure>& figures,
                                                  const Solutions& solutions);

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
