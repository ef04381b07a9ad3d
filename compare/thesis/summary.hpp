#pragma once

#include "compare/thesis/entries.hpp"

namespace springproof::compare {

/// How many published figures of one kind are met within a bound, in points of percent or the kind's unit.
struct Within {
  double bound;
  int declared;   ///< by the declared reference
  int other_only; ///< by another reference, and not by the declared one
  int neither;    ///< by none, those without a value among them
};

struct SummaryGroup {
  std::string name; ///< "errors, beta_1 aside", "errors in beta_1", "volumes (5.2)", ...
  std::string unit; ///< "points" or "mm3" ...
  int n_entries;
  std::vector<Within> within;
  double listing_bound; ///< entries beyond it are listed
  Trace trace;          ///< counts again
  /// By every reference; the entry's finding explains it, or nothing does.
  std::vector<const TableEntry*> beyond;
};

/// Counts what is reproduced; pointers go into `entries`.
std::vector<SummaryGroup> summarise(const std::vector<TableEntry>& entries);

} // namespace springproof::compare
