#include "compare/write/json.hpp"
#include "compare/write/write.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ostream.h>
#include <fmt/ranges.h>

namespace springproof::compare {

using Json = nlohmann::ordered_json;

namespace {

/// The reason that all measures share, if there is one: then it is told once.
std::string common_reason(const MeshStudy& study) {
  const auto same = [&](const StudiedMeasure& m) { return m.reason == study.measures.front().reason; };
  const bool is_common =
      !study.measures.empty() && std::all_of(study.measures.begin(), study.measures.end(), same);
  return is_common ? study.measures.front().reason : "";
}

void write_measure(std::ostream& out, const StudiedMeasure& measure) {
  fmt::print(out, "  {:<24}", measure.name);
  for (const double value : measure.values) fmt::print(out, " {:>12.6g}", value);
  if (measure.limit)
    fmt::print(out, " {:>7.2f} {:>12.6g} {:>10.2g} {:>10.2g}\n", measure.limit->order,
               measure.limit->extrapolated, measure.limit->index_percent,
               *measure.discretisation_error_percent);
  else
    fmt::print(out, "  no limit: {}\n", measure.reason);
}

} // namespace

void write_text(std::ostream& out, const MeshStudy& study) {
  if (const std::string reason = common_reason(study); !reason.empty()) {
    fmt::print(out, "  no discretisation error: {}\n", reason);
    return;
  }
  fmt::print(out, "  fem on refined meshes    ");
  for (const int refine : study.refine) fmt::print(out, " {:>12}", fmt::format("refine {}", refine));
  fmt::print(out, " {:>7} {:>12} {:>10} {:>10}\n", "order", "limit", "GCI %", "fem +- %");
  for (const StudiedMeasure& measure : study.measures) write_measure(out, measure);
}

void add_mesh_study(nlohmann::ordered_json& side, const MeshStudy& study) {
  Json errors = Json::object(), measures = Json::array();
  for (const StudiedMeasure& m : study.measures) {
    errors[m.name] = m.discretisation_error_percent;
    Json measure{{"name", m.name}, {"values", m.values}};
    if (m.limit) {
      measure["observed_order"] = m.limit->order;
      measure["extrapolated"] = m.limit->extrapolated;
      measure["grid_convergence_index_percent"] = m.limit->index_percent;
    }
    measure["reason"] = m.reason;
    measures.push_back(measure);
  }
  side["discretisation_error_percent"] = errors;
  side["mesh_study"] = {{"refine", study.refine}, {"unknowns", study.unknowns}, {"measures", measures}};
}

} // namespace springproof::compare
