#pragma once

#include "compare/cube/cube_benchmark.hpp"
#include "compare/measure/box_plot.hpp"
#include "compare/modes/eigenspaces.hpp"
#include "compare/thesis/published.hpp"

#include <optional>
#include <string>
#include <vector>

/// What `springproof tables` knows when everything is solved: plain records, which the writers and the report
/// read. Nothing here is computed by a writer again.
namespace springproof::compare {

/// How to compute one number again.
struct Trace {
  std::string case_file;             ///< relative to cases_folder(); empty when no case stands behind it
  std::vector<std::string> settings; ///< for `run CASE --set ...`
  std::string command;               ///< the whole line, as typed in the source folder
};

/// A figure computed against one finite-element reference.
struct ComputedFigure {
  std::string reference;          ///< formulation and element, "small_strain q1_bbar"; "exact" for one cell
  std::optional<double> value;    ///< in the unit of the published one
  std::optional<double> fem, msm; ///< the measure itself, on the side that has it
  /// beta_1 alone: error of (45 deg + beta_2 of the small test), which is what some printed rows hold,
  /// percent.
  std::optional<double> from_beta_2;
  std::optional<double> from_printed_beta_2; ///< the same with the error of beta_2 that is printed, not ours
  std::string reason;                        ///< why there is no value; empty when there is one
  Trace trace;
};

/// One printed figure with what the references give.
struct TableEntry {
  PublishedFigure published;
  std::vector<ComputedFigure> computed; ///< the declared reference first; at least one
  std::string finding;                  ///< what is known to be wrong with the printed figure; empty for most
  const ComputedFigure& declared() const { return computed.front(); }
  std::optional<double> difference(const ComputedFigure& of) const; ///< its value less the published one
  /// The computed figure closest to the published one; null when none has a value.
  const ComputedFigure* nearest() const;
};

/// For a beta_1 entry the computed figure whose from_beta_2 or from_printed_beta_2 is what print holds, to
/// 0.1 points; null if there is none.
const ComputedFigure* explained_by_beta_2(const TableEntry& entry);
/// That one of the two, over all references, which is nearest to print; nothing if there is none.
std::optional<double> nearest_from_beta_2(const TableEntry& entry);

/// Tables 4.1 to 4.3 and the dot diagrams: one cell of edge 2 mm, E = 1 MPa, springs by the linear method.
struct CellAnalysis {
  double poissons_ratio;
  msm::CellStiffness stiffness; ///< N/mm; the same figures are the pseudo-stiffnesses k' = 2 k/(L0 E)
  EigenspaceAnalysis spaces;
};

/// Volumes of one case in one model. Absent when it failed.
struct ModelVolumes {
  std::optional<double> total;     ///< mm³
  std::optional<BoxPlot> per_cell; ///< mm³, of the cells of the body's mesh
};

struct CaseVolumes {
  std::string name;     ///< of the case
  double rest;          ///< of the whole body, mm³
  double rest_per_cell; ///< mm³
  ModelVolumes fem, msm;
  Trace trace{}; ///< gives both bodies' volumes
};

/// Largest change of a cell's volume between the whiskers of figure 5.10, over the three tests of a load set.
struct CellVolumeChange {
  std::string load_set;
  double published;               ///< thesis section 5.3.1.3, percent of the rest volume
  std::optional<double> computed; ///< of the springs; absent if a test failed
};

/// One table with springs of one design: what the error is, whatever print says. Errors against the table's
/// declared reference; volumes count as errors against the finite elements' volume.
struct DesignRow {
  std::string table;
  std::string design; ///< "printed" (the thesis's own figures), "thesis's set", or a method's name
  int n_figures = 0;  ///< that have a value
  int n_missing = 0;  ///< refused or failed
  std::optional<double> worst{}, mean{}; ///< of |error|, percent
  std::string worst_at{};                ///< "large shear alpha_1 nu = 0.49"
  std::vector<std::string> reasons{};    ///< of what is missing, each once
  Trace worst_trace{};                   ///< gives the worst figure
};

/// A design for linear elasticity at one Poisson's ratio, for any Young's modulus E and edge L0, with its
/// errors on the thesis's cube. The errors hold for equal strains, that is equal force/(E L0²).
struct Advice {
  double poissons_ratio;
  std::string design;
  std::optional<msm::CellStiffness> stiffness; ///< over E L0 (volume: over E), no unit; absent when refused
  struct Errors : LoadSetErrors {
    Trace trace{}; ///< gives the worst error
  };
  Errors small, large;         ///< the cube's load sets
  std::string refusal;         ///< why there are no stiffnesses or errors; empty otherwise
  bool is_recommended = false; ///< one at most for each Poisson's ratio
  Trace trace;                 ///< gives the stiffnesses
};

/// How many published figures of one kind are met within a bound, in points of percent or the kind's unit.
struct Within {
  double bound;
  int declared;   ///< by the declared reference
  int other_only; ///< by another reference, and not by the declared one
  int neither;    ///< by none, those without a value among them
};

struct SummaryGroup {
  std::string name; ///< "errors, beta_1 aside", "beta_1", "volumes", ...
  std::string unit; ///< "points" or "mm3" ...
  int n_entries;
  std::vector<Within> within;
  double listing_bound; ///< entries beyond it are listed
  Trace trace;          ///< counts again
  std::vector<const TableEntry*>
      beyond; ///< by every reference; the entry's finding explains it, or nothing does
};

struct PhaseTime {
  std::string phase;
  double seconds;
};

struct ThesisResults {
  std::vector<TableEntry> entries; ///< one per published figure of the tables asked for
  /// Every thesis case once, both sides solved: declared reference, the thesis's stiffnesses, and the case
  /// file's own material. For drawings, volumes and fields.
  std::vector<Comparison> cases;
  std::vector<Trace> case_traces; ///< one per case
  /// The cube of figure 4.15, nu = 0.25 with the printed set: the tests that the tables asked for have in
  /// common with it.
  std::vector<Comparison> figure_4_15;
  std::vector<CellAnalysis> cells;
  std::vector<CaseVolumes> volumes;                  ///< one per case
  std::vector<CellVolumeChange> cell_volume_changes; ///< with table 5.2
  std::vector<DesignRow> designs;
  std::vector<Advice> advice;
  std::vector<PhaseTime> times; ///< the only part that differs from run to run
  int n_workers = 1;
};

/// Counts what is reproduced; pointers go into `entries`.
std::vector<SummaryGroup> summarise(const std::vector<TableEntry>& entries);

} // namespace springproof::compare
