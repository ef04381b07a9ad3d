#pragma once

#include "compare/thesis/table_jobs.hpp"

/// The published errors, volumes and deflections (tables 4.5 to 5.4, figure 5.12) beside the computed ones.
namespace springproof::compare {

/// A figure computed against one finite-element reference.
struct ComputedFigure {
  std::string reference;              ///< formulation and element, "small_strain q1_bbar"; "one q1 cell"
  std::optional<double> value{};      ///< in the unit of the published one
  std::optional<double> fem{}, msm{}; ///< the measure itself, on the side that has it
  /// beta_1 alone: error of (45 deg + beta_2 of the small test), which is what some printed rows hold,
  /// percent.
  std::optional<double> from_beta_2{};
  std::optional<double>
      from_printed_beta_2{}; ///< the same with the error of beta_2 that is printed, not ours
  std::string reason{};      ///< why there is no value; empty when there is one
  Trace trace{};
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

/// The jobs behind an entry.
std::vector<JobPair> entry_jobs(const PublishedFigure& figure);
/// One entry per published figure but those of cells, against each reference.
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

} // namespace springproof::compare
