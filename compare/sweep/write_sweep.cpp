#include "compare/sweep/at_rate.hpp"

#include "cases/case/names.hpp"
#include "compare/measure/box_plot.hpp"
#include "compare/provenance/machine.hpp"
#include "compare/provenance/print.hpp"
#include "compare/table/table.hpp"
#include "compare/write/write.hpp"

#include <algorithm>
#include <functional>

namespace springproof::compare {

namespace {

/// Median and quartiles in milliseconds: "12.1 (11.9-12.4)".
std::string quartiles(const std::vector<double>& seconds) {
  if (seconds.empty()) return "-";
  const BoxPlot box = box_plot(seconds);
  if (seconds.size() == 1) return fmt::format("{:.3g}", 1e3 * box.median);
  return fmt::format("{:.3g} ({:.3g}-{:.3g})", 1e3 * box.median, 1e3 * box.lower_quartile,
                     1e3 * box.upper_quartile);
}

void write_head(std::ostream& out, const Sweep& sweep) {
  const Machine machine = describe_machine();
  print(out, "  machine: {}, {} cores, {}, {}, {}\n", machine.processor, machine.cores, machine.system,
        machine.compiler, machine.blas);
  if (sweep.processes == Processes::one_per_variant)
    print(out, "  one variant at a time, each in a process of its own, on one thread\n");
  else
    print(out, "  one variant at a time, all in one process, so no memory; {} rank{}, one thread each{}\n",
          sweep.n_ranks, sweep.n_ranks == 1 ? "" : "s",
          sweep.n_ranks == 1 ? "" : " (springs on the first alone)");
  print(out,
        "  times: median (quartiles) of n rounds after a warm-up round; n = {} unless {:g} s do not pay "
        "for as many, 1* = no warm-up\n",
        sweep.rules.repetitions, sweep.rules.budget_seconds);
  print(out, "  re-solve: from 95 to 100 % of the load, from the displacement at 95 %\n");
}

void write_reference(std::ostream& out, const Sweep& sweep) {
  if (!sweep.reference) {
    print(out, "no reference: {}\n", sweep.reason_without_reference);
    return;
  }
  const auto& meshes = sweep.plan.reference;
  print(out, "reference: {} on {}, {} and {}, extrapolated; displacements are compared on {}\n",
        method_name(meshes[0]), cells_name(meshes[0].cells), cells_name(meshes[1].cells),
        cells_name(meshes[2].cells), cells_name(sweep.reference->scene.mesh.grid->cells));
  const auto line = [&](const ReferenceValue& v) {
    print(out, "  {:<24} {:>12.6g} {:<4} +- {:.2g} %{}\n", v.name, v.value, v.unit, v.uncertainty_percent,
          v.note.empty() ? "" : "  (" + v.note + ")");
  };
  line(sweep.reference->field);
  for (const ReferenceValue& value : sweep.reference->measures) line(value);
}

Json times(const std::vector<double>& seconds) {
  if (seconds.empty()) return nullptr;
  const BoxPlot box = box_plot(seconds);
  return {{"median", box.median}, {"quartiles", {box.lower_quartile, box.upper_quartile}}, {"all", seconds}};
}

Json counters(const cases::Solution& s) {
  return SPRINGPROOF_MEMBERS(s, newton_iterations, linear_iterations, factorisations, force_evaluations,
                             residual);
}

Json value_to_json(const ReferenceValue& v) {
  return SPRINGPROOF_MEMBERS(v, name, unit, value, uncertainty_percent, note);
}

Json reference_to_json(const Sweep& sweep) {
  if (!sweep.reference) return {{"reason", sweep.reason_without_reference}};
  return {{"method", method_name(sweep.plan.reference.front())},
          {"meshes", json_list(sweep.plan.reference, [](const Variant& mesh) { return mesh.cells; })},
          {"compared_on", sweep.reference->scene.mesh.grid->cells},
          {"field", value_to_json(sweep.reference->field)},
          {"measures", json_list(sweep.reference->measures, value_to_json)}};
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

Json motion_row_to_json(const SweepRow& row) {
  return {{"method", method_name(row.variant)},
          {"cells", row.variant.cells},
          {"step_seconds", row.variant.step},
          {"status", cases::name_of(row.run.first.status)},
          {"message", row.run.first.message},
          {"unknowns", row.run.first.unknowns},
          {"seconds_per_second", median(row.run.first_seconds)},
          {"error_percent", row.field_error_percent}};
}

/// Writes a line for each row, then why some have no answer, or none to another load.
void write_rows(std::ostream& out, const Sweep& sweep, const Columns& columns,
                const std::function<Json(const SweepRow&)>& to_json) {
  Json rows = Json::array();
  std::vector<std::string> reasons;
  for (const SweepRow& row : sweep.rows) {
    const cases::Solution &first = row.run.first, &again = row.run.again;
    if (first.status != cases::Status::converged)
      reasons.push_back(full_name(row.variant) + " " + cases::name_of(first.status) + ": " + first.message);
    else
      rows.push_back(to_json(row));
    if (again.status == cases::Status::failed)
      reasons.push_back(full_name(row.variant) + ": re-solve failed: " + again.message);
  }
  write_table(out, columns, rows);
  for (const std::string& reason : reasons) print(out, "  {}\n", reason);
}

void write_variants_text(std::ostream& out, const Sweep& sweep) {
  Columns columns = columns_of("method cells{:<} tol.=tolerance{:.0e} unknowns n setup,~ms=setup "
                               "first~solve,~ms=solve re-solve,~ms=re-solve New.=first.newton_iterations "
                               "CG=first.linear_iterations fac.=first.factorisations "
                               "for.=first.force_evaluations MB{:.0f} field~%=error_percent.field{:.3g}");
  for (const cases::Measure& measure : sweep.definition.measures)
    columns.push_back({measure.name + " %", "error_percent." + measure.name, "{:+.3g}"});
  write_rows(out, sweep, columns, [&](const SweepRow& row) {
    const VariantRun& run = row.run;
    Json json = row_to_json(sweep, row);
    json.update({{"cells", cells_name(row.variant.cells)},
                 {"n", fmt::format("{}{}", run.first_seconds.size(), run.is_warm ? "" : "*")},
                 {"setup", quartiles(run.setup_seconds)},
                 {"solve", quartiles(run.first_seconds)},
                 {"re-solve", quartiles(run.again_seconds)}});
    if (run.peak_megabytes) json["MB"] = *run.peak_megabytes - run.start_megabytes.value_or(0);
    return json;
  });
}

void write_motions_text(std::ostream& out, const Sweep& sweep) {
  print(out, "  one run of each on one thread, one after the other; times without setting up\n");
  print(out, "  reference: {}; uncertainty {:.2g} %\n", sweep.reference->field.note,
        sweep.reference->field.uncertainty_percent);
  write_rows(out, sweep,
             columns_of("method cells{:<} step,~ms=step{:.4g} unknowns "
                        "s~of~computing~a~second=seconds_per_second{:.3g} error,~%=error_percent{:.3g}"),
             [](const SweepRow& row) {
               Json json = motion_row_to_json(row);
               json.update({{"cells", cells_name(row.variant.cells)}, {"step", 1e3 * row.variant.step}});
               return json;
             });
}

void write_rows_at_rate(std::ostream& out, const Sweep& sweep) {
  if (sweep.reference)
    print(out, "  reference: {}; uncertainty {:.2g} %\n",
          sweep.reference->field.note.empty() ? "the finite elements' limit" : sweep.reference->field.note,
          sweep.reference->field.uncertainty_percent);
  print(out, "  one after the other on one thread; a frame's time is the median of n medians of {} frames\n",
        n_timed_frames - 1);
  write_rows(out, sweep, rate_columns_of_text(sweep.definition),
             [&](const SweepRow& row) { return row_of_text(sweep, row); });
}

} // namespace

void write_sweep_text(std::ostream& out, const Sweep& sweep) {
  const bool moves = sweep.definition.dynamics.has_value();
  print(out, "{}: {}\n", sweep.definition.name, sweep.definition.description);
  for (const std::string& setting : sweep.settings) print(out, "  with {}\n", setting);
  if (sweep.rate) {
    write_rows_at_rate(out, sweep);
  } else if (moves) {
    write_motions_text(out, sweep);
  } else {
    write_head(out, sweep);
    write_variants_text(out, sweep);
    write_reference(out, sweep);
  }
  for (const LeftOut& left : sweep.plan.left_out) print(out, "left out: {}: {}\n", left.what, left.reason);
  if (sweep.rate) {
    print(out, "{}\n", rate_sentence(sweep));
    print(out, "the sweep took {:.0f} s\n", sweep.seconds);
    return;
  }
  if (moves) {
    for (const std::string& sentence : interactive_sentences(sweep)) print(out, "{}\n", sentence);
    return;
  }
  for (const Conclusions& group : conclusions(sweep)) {
    print(out, "{}\n", group.heading);
    for (const std::string& sentence : group.sentences) print(out, "  {}\n", sentence);
  }
  print(out, "the sweep took {:.0f} s\n", sweep.seconds);
}

void write_sweep_csv(std::ostream& out, const Sweep& sweep) {
  if (sweep.rate)
    return write_csv(out, rate_columns(sweep.definition), json_list(sweep.rows, [&](const SweepRow& row) {
                       Json json = rate_row_to_json(sweep, row);
                       json["case"] = sweep.definition.name;
                       return json;
                     }));
  if (sweep.definition.dynamics) {
    Json rows = json_list(sweep.rows, motion_row_to_json);
    for (Json& row : rows) row["case"] = sweep.definition.name;
    return write_csv(
        out,
        columns_of("case method cells_x=cells.0 cells_y=cells.1 cells_z=cells.2 step_s=step_seconds "
                   "status message unknowns seconds_per_second error_percent"),
        rows);
  }
  std::string text = "case method cells_x=cells.0 cells_y=cells.1 cells_z=cells.2 tolerance status message "
                     "unknowns rounds warm_up ";
  for (const char* what : {"setup", "first", "again"})
    text += fmt::format("{0}_lower_quartile_s=seconds.{0}.quartiles.0 {0}_median_s=seconds.{0}.median "
                        "{0}_upper_quartile_s=seconds.{0}.quartiles.1 ",
                        what);
  for (const char* what : {"first", "again"})
    text += fmt::format("{0}_newton={0}.newton_iterations {0}_cg={0}.linear_iterations "
                        "{0}_factorisations={0}.factorisations {0}_forces={0}.force_evaluations ",
                        what);
  Columns columns = columns_of(text + "start_MB=memory_MB.start peak_MB=memory_MB.peak field_error_percent");
  for (const cases::Measure& measure : sweep.definition.measures)
    columns.push_back({measure.name + "_error_percent", "error_percent." + measure.name});
  write_csv(out, columns, json_list(sweep.rows, [&](const SweepRow& row) {
              Json json = row_to_json(sweep, row);
              json.update({{"case", sweep.definition.name},
                           {"tolerance", row.variant.tolerance},
                           {"field_error_percent", row.field_error_percent}});
              if (row.run.again_seconds.empty()) json["again"] = nullptr;
              return json;
            }));
}

Json sweep_to_json(const Sweep& sweep) {
  const bool moves = sweep.definition.dynamics.has_value();
  Json document = provenance();
  document.update({{"case", sweep.definition.name},
                   {"description", sweep.definition.description},
                   {"settings", sweep.settings},
                   {"threads", 1}});
  if (sweep.rate) {
    document.update({{"at_hertz", sweep.rate->hertz},
                     {"budget_seconds", sweep.rate->budget_seconds},
                     {"reference", {{"reason", sweep.reason_without_reference}}}});
    if (sweep.reference)
      document["reference"] = {{"field", value_to_json(sweep.reference->field)},
                               {"measures", json_list(sweep.reference->measures, value_to_json)}};
    document["rows"] =
        json_list(sweep.rows, [&](const SweepRow& row) { return rate_row_to_json(sweep, row); });
  } else if (moves) {
    const ReferenceValue& reference = sweep.reference->field;
    document["reference"] = {{"motion", reference.note},
                             {"uncertainty_percent", reference.uncertainty_percent}};
    document["motions"] = json_list(sweep.rows, motion_row_to_json);
  } else {
    document.update({{"ranks", sweep.n_ranks},
                     {"own_process_per_variant", sweep.processes == Processes::one_per_variant},
                     {"repetitions", sweep.rules.repetitions},
                     {"budget_seconds", sweep.rules.budget_seconds},
                     {"load_change", load_change},
                     {"reference", reference_to_json(sweep)}});
    document["variants"] =
        json_list(sweep.rows, [&](const SweepRow& row) { return row_to_json(sweep, row); });
  }
  document["left_out"] = json_list(
      sweep.plan.left_out, [](const LeftOut& left) { return SPRINGPROOF_MEMBERS(left, what, reason); });
  if (sweep.rate)
    document["conclusions"] = {rate_sentence(sweep)};
  else if (moves)
    document["conclusions"] = interactive_sentences(sweep);
  if (moves && !sweep.rate) return document;
  if (!sweep.rate)
    document["conclusions"] = json_list(conclusions(sweep), [](const Conclusions& group) {
      return SPRINGPROOF_MEMBERS(group, heading, sentences);
    });
  document["seconds"] = sweep.seconds;
  return document;
}

} // namespace springproof::compare
