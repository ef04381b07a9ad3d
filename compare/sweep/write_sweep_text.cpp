#include "cases/case/names.hpp"
#include "compare/measure/box_plot.hpp"
#include "compare/provenance/machine.hpp"
#include "compare/sweep/write_sweep.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

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

std::string percent(const std::optional<double>& value) {
  return value ? fmt::format("{:+.3g}", *value) : "-";
}

void write_head(std::ostream& out, const Sweep& sweep) {
  const Machine machine = describe_machine();
  fmt::print(out, "{}: {}\n", sweep.definition.name, sweep.definition.description);
  fmt::print(out, "  machine: {}, {} cores, {}, {}, {}\n", machine.processor, machine.cores, machine.system,
             machine.compiler, machine.blas);
  if (sweep.processes == Processes::one_per_variant)
    fmt::print(out, "  one variant at a time, each in a process of its own, on one thread\n");
  else
    fmt::print(out,
               "  one variant at a time, all in one process, so no memory; {} rank{}, one thread each{}\n",
               sweep.n_ranks, sweep.n_ranks == 1 ? "" : "s",
               sweep.n_ranks == 1 ? "" : " (springs on the first alone)");
  fmt::print(out,
             "  times: median (quartiles) of n rounds after a warm-up round; n = {} unless {:g} s do not pay "
             "for as many, 1* = no warm-up\n",
             sweep.rules.repetitions, sweep.rules.budget_seconds);
  fmt::print(out, "  re-solve: from 95 to 100 % of the load, from the displacement at 95 %\n");
}

void write_row(std::ostream& out, const SweepRow& row) {
  const VariantRun& run = row.run;
  const cases::Solution& s = run.first;
  fmt::print(out, "  {:<34}{:>10} {:>6}", method_name(row.variant), cells_name(row.variant.cells),
             row.variant.program == Program::calculix ? "-" : fmt::format("{:.0e}", row.variant.tolerance));
  if (s.status != cases::Status::converged) {
    fmt::print(out, "  {}: {}\n", cases::name_of(s.status), s.message);
    return;
  }
  const std::string n = fmt::format("{}{}", run.first_seconds.size(), run.is_warm ? "" : "*");
  fmt::print(out, " {:>8} {:>3} {:>22} {:>22} {:>22} {:>4} {:>5} {:>4} {:>5} {:>7}", s.unknowns, n,
             quartiles(run.setup_seconds), quartiles(run.first_seconds), quartiles(run.again_seconds),
             s.newton_iterations, s.linear_iterations, s.factorisations, s.force_evaluations,
             run.peak_megabytes ? fmt::format("{:.0f}", *run.peak_megabytes - run.start_megabytes.value_or(0))
                                : "-");
  fmt::print(out, " {:>8}", row.field_error_percent ? fmt::format("{:.3g}", *row.field_error_percent) : "-");
  for (const auto& error : row.measure_error_percent) fmt::print(out, " {:>9}", percent(error));
  fmt::print(out, "\n");
  if (run.again.status == cases::Status::failed)
    fmt::print(out, "  {:<34}re-solve failed: {}\n", "", run.again.message);
}

void write_reference(std::ostream& out, const Sweep& sweep) {
  if (!sweep.reference) {
    fmt::print(out, "no reference: {}\n", sweep.reason_without_reference);
    return;
  }
  const auto& meshes = sweep.plan.reference;
  fmt::print(out, "reference: {} on {}, {} and {}, extrapolated; displacements are compared on {}\n",
             method_name(meshes[0]), cells_name(meshes[0].cells), cells_name(meshes[1].cells),
             cells_name(meshes[2].cells), cells_name(sweep.reference->scene.mesh.grid->cells));
  const auto line = [&](const ReferenceValue& v) {
    fmt::print(out, "  {:<24} {:>12.6g} {:<4} +- {:.2g} %{}\n", v.name, v.value, v.unit,
               v.uncertainty_percent, v.note.empty() ? "" : "  (" + v.note + ")");
  };
  line(sweep.reference->field);
  for (const ReferenceValue& value : sweep.reference->measures) line(value);
}

} // namespace

void write_sweep_text(std::ostream& out, const Sweep& sweep) {
  write_head(out, sweep);
  fmt::print(out, "  {:<34}{:>10} {:>6} {:>8} {:>3} {:>22} {:>22} {:>22} {:>4} {:>5} {:>4} {:>5} {:>7} {:>8}",
             "method", "cells", "tol.", "unknowns", "n", "setup, ms", "first solve, ms", "re-solve, ms",
             "New.", "CG", "fac.", "for.", "MB", "field %");
  for (const cases::Measure& measure : sweep.definition.measures)
    fmt::print(out, " {:>9}", measure.name + " %");
  fmt::print(out, "\n");
  for (const SweepRow& row : sweep.rows) write_row(out, row);
  write_reference(out, sweep);
  for (const LeftOut& left : sweep.plan.left_out)
    fmt::print(out, "left out: {}: {}\n", left.what, left.reason);
  for (const Conclusions& group : conclusions(sweep)) {
    fmt::print(out, "{}\n", group.heading);
    for (const std::string& sentence : group.sentences) fmt::print(out, "  {}\n", sentence);
  }
  fmt::print(out, "the sweep took {:.0f} s\n", sweep.seconds);
}

} // namespace springproof::compare
