#include "compare/thesis/build_results.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace springproof::compare {

namespace {

/// Rounding of print, and of the stiffnesses behind it: what counts as the same figure, points.
constexpr double same_figure = 0.1;
/// Near enough to be worth a hint, points.
constexpr double similar_figure = 0.5;

/// The reference whose reading of a beta_1 as 45 deg + beta_2 comes nearest to print, and that reading.
std::pair<const ComputedFigure*, double> nearest_reading(const TableEntry& entry) {
  std::pair<const ComputedFigure*, double> nearest{nullptr, 0};
  const double published = entry.published.value;
  for (const ComputedFigure& c : entry.computed)
    for (const auto& reading : {c.from_beta_2, c.from_printed_beta_2})
      if (reading &&
          (!nearest.first || std::abs(*reading - published) < std::abs(nearest.second - published)))
        nearest = {&c, *reading};
  return nearest;
}

/// Of the beta_1 rows some hold another quantity's error. The definition in the text gives a beta_1 that errs
/// about as much as beta_2 does.
std::string explain_beta_1(const TableEntry& entry) {
  const auto [c, reading] = nearest_reading(entry);
  const double off = c ? std::abs(reading - entry.published.value) : 0;
  if (!c || !(off <= similar_figure))
    return "not beta_1 as the text defines it, nor any other quantity that was tried";
  const std::string what =
      fmt::format("the error of 45 deg + beta_2 of the small test, {:.2f} with {}{}", reading, c->reference,
                  reading == c->from_beta_2 ? "" : " and the printed error of beta_2");
  return (off <= same_figure ? "not beta_1: print holds " : "not beta_1, perhaps ") + what;
}

/// The printed tilt of the left edge under the large shear lies above that reference which meets the tilt of
/// the right edge, although both come from the same two solutions.
std::string explain_alpha_1(const TableEntry& entry, const TableEntry* alpha_2) {
  const ComputedFigure* right = alpha_2 ? alpha_2->nearest() : nullptr;
  if (!right) return "";
  const ComputedFigure& left = entry.computed[static_cast<std::size_t>(right - alpha_2->computed.data())];
  if (!left.value || !(entry.published.value - *left.value > 1)) return "";
  return fmt::format(
      "print lies {:.1f} points above {}, which meets alpha_2 of the same two solutions within {:.1f}",
      entry.published.value - *left.value, left.reference,
      std::abs(*right->value - alpha_2->published.value));
}

bool is_same_test(const PublishedFigure& a, const PublishedFigure& b) {
  return a.table == b.table && a.poissons_ratio == b.poissons_ratio && a.design == b.design &&
         a.load_set == b.load_set && a.test == b.test;
}

const TableEntry* find_beside(const std::vector<TableEntry>& entries, const PublishedFigure& figure,
                              const std::string& measure) {
  for (const TableEntry& entry : entries)
    if (is_same_test(entry.published, figure) && entry.published.measure == measure) return &entry;
  return nullptr;
}

} // namespace

std::optional<double> nearest_from_beta_2(const TableEntry& entry) {
  const auto [computed, reading] = nearest_reading(entry);
  return computed ? std::optional(reading) : std::nullopt;
}

const ComputedFigure* explained_by_beta_2(const TableEntry& entry) {
  const auto [computed, reading] = nearest_reading(entry);
  return computed && std::abs(reading - entry.published.value) <= same_figure ? computed : nullptr;
}

void explain(std::vector<TableEntry>& entries) {
  for (TableEntry& entry : entries) {
    const PublishedFigure& p = entry.published;
    if (p.measure == "beta_1") entry.finding = explain_beta_1(entry);
    if (p.measure == "alpha_1" && p.load_set == "large")
      entry.finding = explain_alpha_1(entry, find_beside(entries, p, "alpha_2"));
  }
}

} // namespace springproof::compare
