#include "compare/thesis/summary.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <set>

namespace springproof::compare {

namespace {

bool is_met(const ComputedFigure& computed, const PublishedFigure& published, double bound) {
  // A difference that is the bound but for rounding of the two figures' decimals counts as within.
  return computed.value && std::abs(*computed.value - published.value) <= bound * (1 + 1e-12);
}

Within count(const std::vector<const TableEntry*>& entries, double bound) {
  Within within{bound, 0, 0, 0};
  for (const TableEntry* entry : entries) {
    const auto is_met_here = [&](const ComputedFigure& c) { return is_met(c, entry->published, bound); };
    const auto& computed = entry->computed;
    const auto first = std::find_if(computed.begin(), computed.end(), is_met_here);
    ++(first == computed.end()     ? within.neither
       : first == computed.begin() ? within.declared
                                   : within.other_only);
  }
  return within;
}

/// A kind of figure, which is counted by itself.
struct Kind {
  const char *name, *unit;
  std::vector<double> bounds;
  double listing_bound;
};

// A figure of one cell is exact: half a unit of the last printed digit is all that may be between, twice that
// where the thesis computed from rounded stiffnesses.
const Kind kinds[] = {{"errors, beta_1 aside", "points", {0.1, 0.5, 1, 2}, 1},
                      {"errors in beta_1", "points", {0.1, 0.5, 1, 2}, 1},
                      {"volumes (5.2)", "mm3", {0.1, 0.5, 1, 2}, 2},
                      {"bar (5.12)", "points", {0.1, 0.5, 1, 1.6, 2}, 1.6},
                      {"pseudo-stiffnesses (4.1)", "", {0.0005, 0.001, 0.002}, 0.0005},
                      {"eigenvalues and multiplicities (4.2), h (4.3)", "", {0.005, 0.01, 0.02}, 0.005}};

/// The name of its kind.
std::string kind_of(const PublishedFigure& figure) {
  if (figure.test == "cell") return kinds[figure.table == "4.1" ? 4 : 5].name;
  if (figure.table == "5.12") return kinds[3].name;
  if (figure.unit == "mm3") return kinds[2].name;
  return kinds[figure.measure == "beta_1" ? 1 : 0].name;
}

} // namespace

std::vector<SummaryGroup> summarise(const std::vector<TableEntry>& entries) {
  std::vector<SummaryGroup> groups;
  for (const Kind& kind : kinds) {
    std::vector<const TableEntry*> members;
    std::set<std::string> tables;
    for (const TableEntry& entry : entries)
      if (kind_of(entry.published) == kind.name) {
        members.push_back(&entry);
        tables.insert(entry.published.table);
      }
    if (members.empty()) continue;
    SummaryGroup group{kind.name, kind.unit, static_cast<int>(members.size()), {}, kind.listing_bound,
                       {},        {}};
    group.trace.command = fmt::format("build/springproof tables {}", fmt::join(tables, " "));
    for (const double bound : kind.bounds) group.within.push_back(count(members, bound));
    for (const TableEntry* entry : members)
      if (count({entry}, kind.listing_bound).neither == 1) group.beyond.push_back(entry);
    groups.push_back(std::move(group));
  }
  return groups;
}

} // namespace springproof::compare
