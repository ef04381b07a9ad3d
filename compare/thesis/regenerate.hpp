#pragma once

#include "compare/cube/cube_benchmark.hpp"
#include "compare/measure/box_plot.hpp"
#include "compare/modes/modes.hpp"
#include "compare/solve/solve_jobs.hpp"

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

/// The thesis's printed figures, read from cases/published/, the solves behind each, and the command that
/// repeats them; the computed ones beside them, and how many are met. Then what `springproof tables` knows
/// when everything is solved: these entries, volumes, and what other designs than the thesis's give, in its
/// tables and as advice for linear elasticity.
namespace springproof::compare {

/// One printed figure: an error of tables 4.5 to 5.4 or of figure 5.12, a volume of table 5.2, or a figure of
/// one cell in tables 4.1 to 4.3 (test "cell").
struct PublishedFigure {
  std::string table;     ///< "4.5"
  std::string material;  ///< "linear_elastic" or "ogden"
  double poissons_ratio; ///< in the finite-element reference
  std::string design;    ///< "linear_method" or "nonlinear_method"
  double design_poissons_ratio;
  std::string load_set; ///< "small" or "large"; empty for the bar and the cell
  std::string test;     ///< "tensile", "shear", "torsion", "bar_1x1x4" ..., "cell"
  /// "L_1" ... "beta_2", "volume", "deflection"; a cell's "edge", "face_diagonal", "internal_diagonal"
  /// (k', eq. 4.21), "fem_eigenvalue_2", "msm_multiplicity_1" (numbered from 1), "h"
  std::string measure;
  std::string unit; ///< "%" for an error, "mm3" for the volume of the springs' body, "N/mm", or "1"
  double value;
};

/// All figures of cases/published/figures.csv, table by table as numbered (5.12 after 5.4).
/// @throws InputError naming the file when a row is broken
const std::vector<PublishedFigure>& published_figures();

/// The tables of these figures, each once.
std::vector<std::string> tables_of(const std::vector<PublishedFigure>& figures);

/// Largest change of a cell's volume without outliers, percent, for a load set; section 5.3.1.3.
double published_cell_volume_change(const std::string& load_set);

/// k_e, k_f, k_d in whole N/m where the thesis prints them for this design of the 1 mm cell, else nothing.
std::optional<std::array<double, 3>>
published_stiffness(const std::string& design, const std::string& material, double design_poissons_ratio);

/// A row of a comma-separated file.
struct CsvRow {
  std::string path; ///< the file's
  std::vector<std::string> fields;
  const std::string& operator[](std::size_t field) const { return fields.at(field); }
  double number(std::size_t field) const; ///< @throws InputError naming the file
};

/// Rows of a comma-separated file without its header, every row as wide as the header.  @throws InputError
std::vector<CsvRow> read_csv(const std::string& path);

/// How to compute one number again.
struct Trace {
  std::string case_file{};             ///< relative to cases_folder(); empty when no case stands behind it
  std::vector<std::string> settings{}; ///< for `run CASE --set ...`
  std::string command{};               ///< the whole line, as typed in the source folder
};

/// A finite-element side that a figure is compared with.
struct FemChoice {
  std::string name;                  ///< formulation and element, "small_strain q1_bbar"
  std::vector<std::string> settings; ///< that make it of the case file; empty for the declared one
};

/// The case file's own [fem], the declared reference, first. The published linear elastic figures come from
/// two references: log strain and small strain, both with B-bar; the one that is not declared is the other.
std::vector<FemChoice> references_of(const PublishedFigure& figure);

/// Path below cases_folder() of the case behind a figure of chapters 4.3 and 5.3.
std::string case_file_of(const PublishedFigure& figure);

/// The two sides of one case, solved apart: many springs are compared with the same finite elements.
struct JobPair {
  SolveJob fem, msm;
};

/// Jobs against a reference, with the thesis's springs: the published ones (the bar's case files scale them
/// to their cells), else those of its method.
JobPair thesis_jobs(const PublishedFigure& figure, const FemChoice& reference);
/// The same against the declared reference.
JobPair thesis_jobs(const PublishedFigure& figure);

/// Jobs against the declared reference, with springs that a method designs from the figure's own material,
/// whatever the thesis designed from.
JobPair designed_jobs(const PublishedFigure& figure, const std::string& design);

/// How to run both jobs of one case at once.
Trace trace_of(const JobPair& jobs);

/// The words of a command line of the program, quoted for a shell where needed.
std::string shell_command(const std::vector<std::string>& words);

/// The jobs solved, each once, however many figures share it.
using Solutions = std::map<SolveJob, Comparison>;

/// The springs' case with the finite elements' answer.
Comparison join(const Solutions& solutions, const JobPair& jobs);

/// A measure on the two sides of a case.
struct MeasuredPair {
  std::optional<double> fem, msm;
  std::string reason;                  ///< why one is missing; empty when both are there
  std::optional<double> error() const; ///< error_percent() of both
};
MeasuredPair measured_pair(const Solutions& solutions, const JobPair& jobs, const std::string& measure);

/// A figure computed against one finite-element reference.
struct ComputedFigure {
  std::string reference;              ///< formulation and element, "small_strain q1_bbar"; "one q1 cell"
  std::optional<double> value{};      ///< in the unit of the published one
  std::optional<double> fem{}, msm{}; ///< the measure itself, on the side that has it
  /// beta_1 alone: error of (45 deg + beta_2 of the small test), which is what some printed rows hold,
  /// percent.
  std::optional<double> from_beta_2{};
  std::optional<double> from_printed_beta_2{}; ///< the same with the printed error of beta_2, not ours
  std::string reason{};                        ///< why there is no value; empty when there is one
  Trace trace{};
};

/// One printed figure with what the references give.
struct TableEntry {
  PublishedFigure published;
  std::vector<ComputedFigure> computed; ///< the declared reference first; at least one
  std::string finding;                  ///< what is known to be wrong with the printed figure; empty for most
  const ComputedFigure& declared() const { return computed.front(); }
  std::optional<double> difference(const ComputedFigure& of) const; ///< its value less the published one
  bool has_failed() const; ///< whether it has no value against some reference
  /// The computed figure closest to the published one; null when none has a value.
  const ComputedFigure* nearest() const;
};

/// The jobs behind an entry.
std::vector<JobPair> entry_jobs(const PublishedFigure& figure);
/// One entry per published figure of tables 4.5 to 5.4 and figure 5.12, against each reference.
std::vector<TableEntry> error_entries(const std::vector<PublishedFigure>& figures,
                                      const Solutions& solutions);

/// A beta_1 entry's from_beta_2 or from_printed_beta_2 of a reference.
struct BetaReading {
  const ComputedFigure* reference; ///< null: there is none
  double value;                    ///< percent
};
/// That one of them, over all references, which is closest to the published value.
BetaReading nearest_from_beta_2(const TableEntry& entry);

/// What is known of printed figures that no computation meets, into the entries' `finding`.
void explain(std::vector<TableEntry>& entries);

/// How many published figures of one kind are met within a bound, in points of percent or the kind's unit.
struct Within {
  double bound;
  int declared;   ///< met by the declared reference
  int other_only; ///< met by another reference, and not by the declared one
  int neither;    ///< met by none, those without a value among them
};

struct SummaryGroup {
  std::string name; ///< "errors, beta_1 aside", "errors in beta_1", "volumes (5.2)", ...
  std::string unit; ///< "points" or "mm3" ...
  int n_entries;
  std::vector<Within> within;
  double listing_bound;  ///< entries beyond it are listed
  std::string command{}; ///< counts again
  /// Entries that no reference meets; the entry's finding explains it, or nothing does.
  std::vector<const TableEntry*> beyond{};
  int n_failed = 0;     ///< without a value against some reference, whatever the others give
  int n_reproduced = 0; ///< entries without a failure within the listing bound
};

/// Counts what is reproduced; pointers go into `entries`.
std::vector<SummaryGroup> summarise(const std::vector<TableEntry>& entries);

struct CellAnalysis {
  double poissons_ratio;
  msm::CellStiffness stiffness; ///< N/mm; the same figures are the pseudo-stiffnesses k' = 2 k/(L0 E)
  EigenspaceAnalysis spaces;
};

/// The cells of these figures' Poisson's ratios, ascending, each once.
std::vector<CellAnalysis> analyse_cells(const std::vector<PublishedFigure>& figures);

/// One entry per published figure of a cell.
std::vector<TableEntry> cell_entries(const std::vector<PublishedFigure>& figures,
                                     const std::vector<CellAnalysis>& cells);

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
