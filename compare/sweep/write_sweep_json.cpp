#include "cases/case/names.hpp"
#include "compare/measure/box_plot.hpp"
#include "compare/sweep/write_sweep.hpp"
#include "compare/write/json.hpp"
#include "compare/write/write.hpp"

namespace springproof::compare {

namespace {

using Json = nlohmann::ordered_json;

Json times(const std::vector<double>& seconds) {
  if (seconds.empty()) return nullptr;
  const BoxPlot box = box_plot(seconds);
  return {{"median", box.median}, {"quartiles", {box.lower_quartile, box.upper_quartile}}, {"all", seconds}};
}

Json counters(const cases::Solution& s) {
  return {{"newton_iterations", s.newton_iterations},
          {"linear_iterations", s.linear_iterations},
          {"factorisations", s.factorisations},
          {"force_evaluations", s.force_evaluations},
          {"residual", s.residual}};
}

Json value_to_json(const ReferenceValue& v) {
  return {{"name", v.name},
          {"unit", v.unit},
          {"value", v.value},
          {"uncertainty_percent", v.uncertainty_percent},
          {"note", v.note}};
}

Json reference_to_json(const Sweep& sweep) {
  if (!sweep.reference) return {{"reason", sweep.reason_without_reference}};
  Json document{{"method", method_name(sweep.plan.reference.front())},
                {"meshes", Json::array()},
                {"compared_on", sweep.reference->scene.mesh.grid->cells},
                {"field", value_to_json(sweep.reference->field)},
                {"measures", Json::array()}};
  for (const Variant& mesh : sweep.plan.reference) document["meshes"].push_back(mesh.cells);
  for (const ReferenceValue& value : sweep.reference->measures)
    document["measures"].push_back(value_to_json(value));
  return document;
}

Json row_to_json(const Sweep& sweep, const SweepRow& row) {
  const VariantRun& run = row.run;
  Json errors{{"field", row.field_error_percent}};
  for (std::size_t m = 0; m < row.measure_error_percent.size(); ++m)
    errors[sweep.definition.measures[m].name] = row.measure_error_percent[m];
  return {
      {"method", method_name(row.variant)},
      {"cells", row.variant.cells},
      {"tolerance", row.variant.program == Program::calculix ? Json(nullptr) : Json(row.variant.tolerance)},
      {"status", cases::name_of(run.first.status)},
      {"message", run.first.message},
      {"unknowns", run.first.unknowns},
      {"rounds", run.first_seconds.size()},
      {"warm_up", run.is_warm},
      {"seconds",
       {{"setup", times(run.setup_seconds)},
        {"first", times(run.first_seconds)},
        {"again", times(run.again_seconds)}}},
      {"first", counters(run.first)},
      {"again", run.again.status == cases::Status::skipped ? Json(nullptr) : counters(run.again)},
      {"again_message", run.again.message},
      {"memory_MB", {{"start", run.start_megabytes}, {"peak", run.peak_megabytes}}},
      {"error_percent", errors}};
}

} // namespace

Json sweep_to_json(const Sweep& sweep) {
  Json document = provenance();
  document["case"] = sweep.definition.name;
  document["description"] = sweep.definition.description;
  document["threads"] = 1;
  document["ranks"] = sweep.n_ranks;
  document["own_process_per_variant"] = sweep.processes == Processes::one_per_variant;
  document["repetitions"] = sweep.rules.repetitions;
  document["budget_seconds"] = sweep.rules.budget_seconds;
  document["load_change"] = load_change;
  document["reference"] = reference_to_json(sweep);
  document["variants"] = Json::array();
  for (const SweepRow& row : sweep.rows) document["variants"].push_back(row_to_json(sweep, row));
  document["left_out"] = Json::array();
  for (const LeftOut& left : sweep.plan.left_out)
    document["left_out"].push_back({{"what", left.what}, {"reason", left.reason}});
  document["conclusions"] = Json::array();
  for (const Conclusions& group : conclusions(sweep))
    document["conclusions"].push_back({{"heading", group.heading}, {"sentences", group.sentences}});
  document["seconds"] = sweep.seconds;
  return document;
}

} // namespace springproof::compare
