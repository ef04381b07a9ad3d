#include "compare/write/measures_text.hpp"

#include "cases/case/read_case.hpp"
#include "compare/measure/measure.hpp"
#include "compare/table/table.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <utility>

namespace springproof::compare {

namespace {

std::string number(const std::optional<double>& value, const char* format) {
  return value ? fmt::format(fmt::runtime(format), *value) : "-";
}

/// "9.23 +- 1.1", or without the error bar; "-" when there is no value.
std::string with_bar(const std::optional<double>& value, const char* format,
                     const std::optional<double>& bar) {
  return number(value, format) + (bar ? fmt::format(" +- {:.2g}", *bar) : "");
}

/// An error; of a measure whose reference is zero there is none. The norm of a difference is marked.
std::string error_text(const MeasuredValue& measure, bool is_of_difference) {
  const std::optional<double> reference =
      measure.fem_limit ? std::optional(measure.fem_limit->value) : measure.fem;
  if (!measure.error_percent && reference && measure.msm) return "no percentage";
  if (!is_of_difference) return with_bar(measure.error_percent, "{:+.2f}", measure.error_uncertainty_percent);
  return with_bar(measure.error_percent, "{:.2f}", measure.error_uncertainty_percent) +
         (measure.error_percent ? "*" : "");
}

void write_table(std::ostream& out, const Comparison& comparison) {
  const std::vector<MeasuredValue>& measures = comparison.measures;
  const auto& peer = comparison.answers.peer;
  const bool has_limits = std::any_of(measures.begin(), measures.end(),
                                      [](const MeasuredValue& m) { return m.fem_limit.has_value(); });
  Columns columns{{"measure"}, {"unit"}, {"fem"}, {"springs"}};
  if (has_limits) columns.push_back({"fem's limit"});
  columns.push_back({"error %"});
  if (has_limits) columns.push_back({"fem's error %"});
  if (peer) columns.push_back({peer->program});
  TextTable table(std::move(columns));
  for (const MeasuredValue& m : measures) {
    const auto& limit = m.fem_limit;
    std::vector<std::string> row{m.name, m.unit, number(m.fem, "{:.6g}"), number(m.msm, "{:.6g}")};
    if (has_limits) row.push_back(limit ? with_bar(limit->value, "{:.6g}", limit->uncertainty) : "-");
    row.push_back(error_text(m, is_norm(m, comparison.scene.definition)));
    if (has_limits)
      row.push_back(
          number(m.fem_error_percent, is_norm(m, comparison.scene.definition) ? "{:.2f}*" : "{:+.2f}"));
    if (peer) row.push_back(number(m.peer, "{:.6g}"));
    table.add(std::move(row));
  }
  table.write(out);
}

/// What a value of all measures has in common, if it has: then it is told once.
template<class Get>
std::string common_text(const std::vector<StudiedMeasure>& measures, const Get& get) {
  const bool is_common =
      !measures.empty() && std::all_of(measures.begin(), measures.end(), [&](const StudiedMeasure& m) {
        return get(m) == get(measures.front());
      });
  return is_common ? get(measures.front()) : "";
}

/// Why the errors are against the same mesh, of those measures of which they are.
void write_missing_limits(std::ostream& out, const MeshStudy& study) {
  const auto reason = [](const StudiedMeasure& m) { return m.no_reference; };
  if (const std::string common = common_text(study.measures, reason); !common.empty()) {
    write_wrapped(out, "  errors are against the finite elements on the same mesh: " + common, 4);
    return;
  }
  for (const StudiedMeasure& m : study.measures)
    if (!m.reference)
      write_wrapped(out, "  " + m.name + ": error against the same mesh: " + m.no_reference, 4);
}

void write_missing_values(std::ostream& out, const MeasuredValue& m) {
  for (const auto& [side, reason] : {std::pair("fem", &m.fem_reason), std::pair("springs", &m.msm_reason)})
    if (!reason->empty())
      write_wrapped(out, fmt::format("  {}: no value of {}: {}", m.name, side, *reason), 4);
}

/// The study on its finest meshes.
TextTable study_table(const MeshStudy& study, std::size_t n_meshes) {
  const std::size_t first = study.refine.size() - n_meshes;
  Columns columns{{"fem on refined meshes"}};
  for (std::size_t mesh = first; mesh < study.refine.size(); ++mesh)
    columns.push_back({fmt::format("refine {}", study.refine[mesh])});
  columns.insert(columns.end(), {{"order"}, {"limit"}, {"GCI %"}, {"fem +- %"}});
  TextTable table(std::move(columns));
  for (const StudiedMeasure& measure : study.measures) {
    std::vector<std::string> row{measure.name};
    for (std::size_t mesh = first; mesh < study.refine.size(); ++mesh)
      row.push_back(mesh < measure.values.size() ? fmt::format("{:.6g}", measure.values[mesh]) : "-");
    if (const auto& limit = measure.limit)
      row.insert(row.end(), {fmt::format("{:.2f}", limit->order), fmt::format("{:.6g}", limit->extrapolated),
                             fmt::format("{:.2g}", limit->index_percent),
                             number(measure.discretisation_error_percent, "{:.2g}")});
    else
      row.insert(row.end(), {"-", "-", "-", "-"});
    table.add(std::move(row));
  }
  return table;
}

} // namespace

bool is_norm(const MeasuredValue& measured, const cases::Case& definition) {
  const cases::Measure* measure = find_named(definition.measures, measured.name);
  return measure ? is_field_norm(measure->kind) || is_trajectory_norm(*measure)
                 : measured.name == cases::surface_measure;
}

void write_measures_text(std::ostream& out, const Comparison& comparison) {
  if (comparison.measures.empty()) return;
  write_table(out, comparison);
  if (std::any_of(comparison.measures.begin(), comparison.measures.end(), [&](const MeasuredValue& m) {
        return m.error_percent && is_norm(m, comparison.scene.definition);
      }))
    write_wrapped(out,
                  "  * of a field over the body, or of a course over time: the norm of the difference, which "
                  "has no sign",
                  4);
  if (comparison.mesh_study) write_missing_limits(out, *comparison.mesh_study);
  for (const MeasuredValue& m : comparison.measures) write_missing_values(out, m);
}

void write_mesh_study_text(std::ostream& out, const MeshStudy& study) {
  std::size_t n_meshes = study.refine.size();
  if (n_meshes < 2) return;
  while (n_meshes > 3 && study_table(study, n_meshes).width() > screen_width) --n_meshes;
  study_table(study, n_meshes).write(out);
  if (n_meshes < study.refine.size())
    write_wrapped(out, "  values on coarser meshes: in --json, and in results.json of --out", 4);
  for (const StudiedMeasure& measure : study.measures)
    if (!measure.limit)
      write_wrapped(out, fmt::format("  {}: no order: {}", measure.name, measure.reason), 4);
}

} // namespace springproof::compare
