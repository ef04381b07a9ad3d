#pragma once

#include "compare/modes/modes.hpp"
#include "compare/thesis/published.hpp"

/// The published figures beside the computed ones, what is known of those that are not met, and how many are.
namespace springproof::compare {

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

} // namespace springproof::compare
