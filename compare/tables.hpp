#pragma once

#include "compare/comparison.hpp"
#include "compare/published.hpp"

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <ostream>
#include <string>
#include <vector>

namespace compare {

/// A figure computed against one finite-element reference, and how to compute it again.
struct ComputedFigure {
  std::string reference;             ///< formulation and element, "small_strain q1_bbar"
  std::optional<double> value;       ///< in the unit of the published one
  std::optional<double> fem, msm;    ///< the measure itself
  std::string reason;                ///< why there is no value; empty when there is one
  std::string case_file;             ///< relative to cases_folder()
  std::vector<std::string> settings; ///< for `run CASE --set ...`
};

/// One printed figure with what the declared references give.
struct TableEntry {
  PublishedFigure published;
  std::vector<ComputedFigure> computed; ///< one per reference, at least one
  /// Of the computed ones that nearest to print; null when none has a value.
  const ComputedFigure* nearest() const;
};

/// Numbers of the tables that can be regenerated, in order.
std::vector<std::string> known_tables();

/// Solves every case behind the tables once per reference and pairs the results with print.
/// @param progress  told the number of comparisons done and in all
/// @throws InputError for an unknown table
std::vector<TableEntry> regenerate(const std::vector<std::string>& tables,
                                   const std::function<void(int done, int all)>& progress);

/// As in print: a row per measure, a column per variant; per row ours (each reference), published and the
/// difference.
void write_tables_text(std::ostream& out, const std::vector<TableEntry>& entries);

/// One row per entry and reference.
void write_tables_csv(std::ostream& out, const std::vector<TableEntry>& entries);

/// The document of `tables --json`.
nlohmann::ordered_json tables_to_json(const std::vector<TableEntry>& entries);

} // namespace compare
