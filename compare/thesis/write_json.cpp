#include "compare/thesis/write_json.hpp"

#include "compare/cube/write_design.hpp"
#include "compare/thesis/summary.hpp"
#include "compare/write/json.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace springproof::compare {

using Json = nlohmann::ordered_json;

namespace {

Json text_or_null(const std::string& text) {
  return text.empty() ? Json(nullptr) : Json(text);
}

Json entry_to_json(const TableEntry& entry) {
  const PublishedFigure& p = entry.published;
  const ComputedFigure& declared = entry.declared();
  Json other = Json::object(), other_command = Json::object();
  for (std::size_t k = 1; k < entry.computed.size(); ++k) {
    other[entry.computed[k].reference] = entry.computed[k].value;
    other_command[entry.computed[k].reference] = entry.computed[k].trace.command;
  }
  const ComputedFigure* nearest = entry.nearest();
  Json row{{"table", p.table},
           {"material", p.material},
           {"poissons_ratio", p.poissons_ratio},
           {"design", p.design},
           {"design_poissons_ratio", p.design_poissons_ratio},
           {"load_set", p.load_set},
           {"test", p.test},
           {"measure", p.measure},
           {"unit", p.unit},
           {"published", p.value},
           {"computed", declared.value},
           {"difference", entry.difference(declared)},
           {"reference", declared.reference},
           {"other", other},
           {"nearest", nearest ? Json(nearest->reference) : Json(nullptr)},
           {"fem", declared.fem},
           {"msm", declared.msm},
           {"finding", text_or_null(entry.finding)},
           {"reason", text_or_null(declared.reason)},
           {"case", text_or_null(declared.trace.case_file)},
           {"settings", declared.trace.settings},
           {"command", declared.trace.command},
           {"other_command", other_command}};
  if (p.measure == "beta_1") {
    row["from_beta_2"] = Json::object();
    for (const ComputedFigure& c : entry.computed) row["from_beta_2"][c.reference] = c.from_beta_2;
  }
  return row;
}

Json group_to_json(const SummaryGroup& group, const std::vector<TableEntry>& entries) {
  Json within = Json::array(), beyond = Json::array();
  for (const Within& w : group.within)
    within.push_back(
        {{"bound", w.bound}, {"declared", w.declared}, {"other_only", w.other_only}, {"neither", w.neither}});
  for (const TableEntry* entry : group.beyond)
    beyond.push_back({{"entry", entry - entries.data()},
                      {"explanation", entry->finding.empty() ? "unexplained" : entry->finding}});
  return {{"name", group.name},
          {"unit", group.unit},
          {"entries", group.n_entries},
          {"within", within},
          {"listing_bound", group.listing_bound},
          {"beyond", beyond}};
}

/// Errors, beta_1 among them, that the nearest reference brings within so many points.
auto count_nearest(const std::vector<TableEntry>& entries, double points) {
  return std::count_if(entries.begin(), entries.end(), [&](const TableEntry& entry) {
    const ComputedFigure* nearest = entry.nearest();
    return entry.published.unit == "%" && nearest && std::abs(*entry.difference(*nearest)) <= points;
  });
}

Json design_to_json(const DesignRow& row) {
  return {{"table", row.table},
          {"design", row.design},
          {"figures", row.errors.n},
          {"missing", row.n_missing},
          {"mean_error_percent", row.errors.mean()},
          {"worst_error_percent", row.errors.worst},
          {"worst_at", row.worst_at},
          {"reasons", row.reasons},
          {"command_of_worst", text_or_null(row.worst_trace.command)}};
}

Json box_to_json(const std::optional<ModelVolumes>& v) {
  if (!v) return nullptr;
  const BoxPlot& b = v->per_cell;
  return {{"total_mm3", v->total},
          {"quartiles", {b.lower_quartile, b.median, b.upper_quartile}},
          {"whiskers", {b.lower_whisker, b.upper_whisker}},
          {"outliers", b.outliers}};
}

Json volumes_to_json(const CaseVolumes& v) {
  return {{"case", v.name},
          {"rest_mm3", v.rest},
          {"rest_per_cell_mm3", v.rest_per_cell},
          {"fem", box_to_json(v.fem)},
          {"msm", box_to_json(v.msm)},
          {"command", v.trace.command}};
}

Json change_to_json(const CellVolumeChange& change) {
  return {{"load_set", change.load_set},
          {"published_percent", change.published},
          {"computed_percent", change.computed}};
}

Json advice_to_json(const Advice& a) {
  Json row{{"poissons_ratio", a.poissons_ratio},
           {"design", a.design},
           {"recommended", a.is_recommended},
           {"stiffness_per_E_L0", nullptr},
           {"volume_stiffness_per_E", nullptr},
           {"small", errors_to_json(a.cube.small)},
           {"large", errors_to_json(a.cube.large)},
           {"reason", text_or_null(a.refusal())},
           {"command", a.trace.command}};
  if (a.stiffness) {
    row["stiffness_per_E_L0"] = {a.stiffness->edge, a.stiffness->face_diagonal,
                                 a.stiffness->internal_diagonal};
    row["volume_stiffness_per_E"] = a.stiffness->volume;
  }
  row["small"]["command_of_worst"] = text_or_null(a.small_trace.command);
  row["large"]["command_of_worst"] = text_or_null(a.large_trace.command);
  return row;
}

template<class Record, class ToJson>
Json list(const std::vector<Record>& records, const ToJson& to_json) {
  Json rows = Json::array();
  for (const Record& record : records) rows.push_back(to_json(record));
  return rows;
}

} // namespace

Json results_to_json(const ThesisResults& results) {
  Json summary{{"entries", results.entries.size()}};
  for (const double points : {0.1, 0.5, 1.0, 2.0})
    summary[fmt::format("within_{:g}_points", points)] = count_nearest(results.entries, points);
  summary["groups"] = list(summarise(results.entries),
                           [&](const SummaryGroup& group) { return group_to_json(group, results.entries); });
  return {{"schema", 1},
          {"entries", list(results.entries, entry_to_json)},
          {"designs", list(results.designs, design_to_json)},
          {"volumes", list(results.volumes, volumes_to_json)},
          {"cell_volume_changes", list(results.cell_volume_changes, change_to_json)},
          {"advice", list(results.advice, advice_to_json)},
          {"summary", summary}};
}

} // namespace springproof::compare
