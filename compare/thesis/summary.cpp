#include "compare/thesis/results.hpp"

#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <set>

namespace springproof::compare {

namespace {

bool is_met(const ComputedFigure& computed, const PublishedFigure& published, double bound) {
  // A difference that is the bound but for rounding of the two figures' decimals counts as within.
  return computed.value && std::abs(*computed.value - published.value) <= bound * (1 + 1e-12);
}

bool is_met_by_other(const TableEntry& entry, double bound) {
  for (std::size_t k = 1; k < entry.computed.size(); ++k)
    if (is_met(entry.computed[k], entry.published, bound)) return true;
  return false;
}

Within count(const std::vector<const TableEntry*>& entries, double bound) {
  Within within{bound, 0, 0, 0};
  for (const TableEntry* entry : entries)
    ++(is_met(entry->declared(), entry->published, bound) ? within.declared
       : is_met_by_other(*entry, bound)                   ? within.other_only
                                                          : within.neither);
  return within;
}

/// The tables that these stand in, and no other.
Trace tables_of(const std::vector<const TableEntry*>& entries) {
  std::set<std::string> tables;
  for (const TableEntry* entry : entries) tables.insert(entry->published.table);
  Trace trace;
  trace.command = fmt::format("build/springproof tables {}", fmt::join(tables, " "));
  return trace;
}

/// A kind of figure, which is counted by itself.
struct Kind {
  std::string name, unit;
  std::vector<double> bounds;
  double listing_bound;
  std::function<bool(const PublishedFigure&)> has;
};

const std::vector<Kind>& kinds() {
  const auto is_error = [](const PublishedFigure& p) { return p.unit == "%" && p.table != "5.12"; };
  // A figure of one cell is exact: half a unit of the last printed digit is all that may be between, twice
  // that where the thesis computed from rounded stiffnesses.
  static const std::vector<Kind> all{
      {"errors, beta_1 aside",
       "points",
       {0.1, 0.5, 1, 2},
       1,
       [=](const PublishedFigure& p) { return is_error(p) && p.measure != "beta_1"; }},
      {"errors in beta_1",
       "points",
       {0.1, 0.5, 1, 2},
       1,
       [=](const PublishedFigure& p) { return is_error(p) && p.measure == "beta_1"; }},
      {"volumes (5.2)", "mm3", {0.1, 0.5, 1, 2}, 2, [](const PublishedFigure& p) { return p.unit == "mm3"; }},
      {"bar (5.12)",
       "points",
       {0.1, 0.5, 1, 1.6, 2},
       1.6,
       [](const PublishedFigure& p) { return p.table == "5.12"; }},
      {"pseudo-stiffnesses (4.1)",
       "",
       {0.0005, 0.001, 0.002},
       0.0005,
       [](const PublishedFigure& p) { return p.table == "4.1"; }},
      {"eigenvalues and multiplicities (4.2), h (4.3)",
       "",
       {0.005, 0.01, 0.02},
       0.005,
       [](const PublishedFigure& p) { return p.table == "4.2" || p.table == "4.3"; }}};
  return all;
}

} // namespace

std::vector<SummaryGroup> summarise(const std::vector<TableEntry>& entries) {
  std::vector<SummaryGroup> groups;
  for (const Kind& kind : kinds()) {
    std::vector<const TableEntry*> members;
    for (const TableEntry& entry : entries)
      if (kind.has(entry.published)) members.push_back(&entry);
    if (members.empty()) continue;
    SummaryGroup group{kind.name, kind.unit,          static_cast<int>(members.size()),
                       {},        kind.listing_bound, tables_of(members),
                       {}};
    for (const double bound : kind.bounds) group.within.push_back(count(members, bound));
    for (const TableEntry* entry : members)
      if (count({entry}, kind.listing_bound).neither == 1) group.beyond.push_back(entry);
    groups.push_back(std::move(group));
  }
  return groups;
}

} // namespace springproof::compare
