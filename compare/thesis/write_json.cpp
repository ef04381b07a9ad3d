#include "compare/cube/write_design.hpp"
#include "compare/thesis/write.hpp"
#include "compare/write/json.hpp"

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
int count_nearest(const std::vector<TableEntry>& entries, double points) {
  int n = 0;
  for (const TableEntry& entry : entries) {
    const ComputedFigure* nearest = entry.nearest();
    if (entry.published.unit == "%" && nearest && std::abs(*nearest->value - entry.published.value) <= points)
      ++n;
  }
  return n;
}

Json design_to_json(const DesignRow& row) {
  return {{"table", row.table},
          {"design", row.design},
          {"figures", row.n_figures},
          {"missing", row.n_missing},
          {"mean_error_percent", row.mean},
          {"worst_error_percent", row.worst},
          {"worst_at", row.worst_at},
          {"reasons", row.reasons},
          {"command_of_worst", text_or_null(row.worst_trace.command)}};
}

Json box_to_json(const ModelVolumes& v) {
  if (!v.total || !v.per_cell) return nullptr;
  const BoxPlot& b = *v.per_cell;
  return {{"total_mm3", *v.total},
          {"quartiles", {b.lower_quartile, b.median, b.upper_quartile}},
          {"whiskers", {b.lower_whisker, b.upper_whisker}},
          {"outliers", b.outliers}};
}

Json with_command(const Advice::Errors& errors) {
  Json document = errors_to_json(errors);
  document["command_of_worst"] = text_or_null(errors.trace.command);
  return document;
}

Json advice_to_json(const Advice& a) {
  Json row{{"poissons_ratio", a.poissons_ratio}, {"design", a.design}, {"recommended", a.is_recommended}};
  row["stiffness_per_E_L0"] = nullptr;
  row["volume_stiffness_per_E"] = nullptr;
  if (a.stiffness) {
    row["stiffness_per_E_L0"] = {a.stiffness->edge, a.stiffness->face_diagonal,
                                 a.stiffness->internal_diagonal};
    row["volume_stiffness_per_E"] = a.stiffness->volume;
  }
  row["small"] = with_command(a.small);
  row["large"] = with_command(a.large);
  row["reason"] = text_or_null(a.refusal);
  row["command"] = a.trace.command;
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
          {"volumes", list(results.volumes,
                           [](const CaseVolumes& v) {
                             return Json{{"case", v.name},
                                         {"rest_mm3", v.rest},
                                         {"rest_per_cell_mm3", v.rest_per_cell},
                                         {"fem", box_to_json(v.fem)},
                                         {"msm", box_to_json(v.msm)},
                                         {"command", v.trace.command}};
                           })},
          {"cell_volume_changes", list(results.cell_volume_changes,
                                       [](const CellVolumeChange& change) {
                                         return Json{{"load_set", change.load_set},
                                                     {"published_percent", change.published},
                                                     {"computed_percent", change.computed}};
                                       })},
          {"advice", list(results.advice, advice_to_json)},
          {"summary", summary}};
}

} // namespace springproof::compare
