#include "compare/client/judge.hpp"

#include "cases/case/error.hpp"
#include "compare/provenance/machine.hpp"
#include "compare/provenance/print.hpp"
#include "compare/solve/solve.hpp"
#include "compare/solve/springs.hpp"
#include "compare/table/table.hpp"
#include "compare/write/quote.hpp"
#include "compare/write/write.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <numeric>
#include <utility>
#include <variant>

namespace springproof::compare {

namespace {

/// A step that takes no longer than it advances keeps up with real time.
void say_whether_in_time(JudgedRow& row, const cases::Scene& scene, const ClientBudget& budget) {
  const double step = scene.definition.dynamics ? scene.definition.dynamics->step : budget.step;
  if (row.milliseconds_a_step) row.in_real_time = *row.milliseconds_a_step <= 1e3 * step;
}

/// The error of largest size, of the measures that have one.
void add_worst(JudgedRow& row, std::optional<double> MeasuredValue::*error) {
  WorstError worst;
  for (std::size_t m = 0; m < row.measures.size(); ++m)
    if (row.measures[m].*error) worst.add(*(row.measures[m].*error), m);
  if (!worst.worst) return;
  const MeasuredValue& at = row.measures[worst.place];
  row.worst = at.*error;
  row.worst_at = at.name;
  row.bar = at.error_uncertainty_percent;
}

std::optional<double> volume_error(const cases::Solution& fem, const cases::Solution& other) {
  const auto whole = [](const std::vector<double>& cells) {
    return std::accumulate(cells.begin(), cells.end(), 0.);
  };
  if (fem.cell_volume.empty() || other.cell_volume.empty()) return std::nullopt;
  return 100 * (whole(other.cell_volume) / whole(fem.cell_volume) - 1);
}

/// What rows are held against, and what tells the parts of their errors.
struct Basis {
  const cases::Scene& scene;
  const Answers& fem;
  Parts parts;
  const SpringLattices* lattices; ///< null: of a motion
};

ErrorBudget without_parts(const std::string& measure, const std::string& reason) {
  return {measure, {}, {}, {}, {}, {}, reason};
}

/// @param is_solved  nothing is left by iterations
ErrorBudget parts_of(const Basis& basis, const Comparison& answer, const std::string& measure,
                     bool is_solved) {
  if (basis.scene.definition.dynamics)
    return without_parts(measure, "a body in motion has them by run --error-budget");
  if (!basis.lattices)
    return without_parts(measure, "the case's springs were not solved, so that no finer lattice is known");
  return basis.lattices->budget_of(answer, measure, is_solved);
}

/// What springs, ours or a client's, come to beside the finite elements.
/// @param is_solved  nothing is left by iterations
JudgedRow row_of(std::string model, const Basis& basis, const Answer& answer, bool is_solved) {
  JudgedRow row{std::move(model)};
  if (!answer.converged()) {
    row.failure = answer.solution.message;
    return row;
  }
  Answers springs;
  springs.msm = answer;
  const Comparison compared = compare_sides(basis.scene, basis.fem, springs);
  row.measures = compared.measures;
  row.surface = compared.surface_motion;
  if (answer.solution.trajectory) row.residual = answer.solution.trajectory->largest_residual;
  add_worst(row, &MeasuredValue::error_percent);
  if (basis.parts == Parts::told && row.worst) row.parts = parts_of(basis, compared, row.worst_at, is_solved);
  row.volume = volume_error(basis.fem.fem.solution, answer.solution);
  if (answer.solution.inverted_cells > 0)
    row.warnings.push_back(fmt::format("{} cells are inverted", answer.solution.inverted_cells));
  return row;
}

JudgedRow fem_row(const Basis& basis) {
  const Answers& fem = basis.fem;
  JudgedRow row{fem_model};
  if (!fem.fem.converged()) {
    row.failure = fem.fem.solution.message;
    return row;
  }
  row.measures = compare_sides(basis.scene, fem, Answers{}).measures;
  add_worst(row, &MeasuredValue::fem_error_percent);
  if (basis.lattices && row.worst) { // at rest their mesh is all of it
    const ErrorPart none{0., 0, "zero by construction"};
    row.parts = ErrorBudget{row.worst_at, none, {row.worst, 0, ""}, none, none, row.worst, ""};
  }
  row.milliseconds_a_step = milliseconds_a_step(fem.fem);
  return row;
}

/// A model of ours as a row asks it.
struct OwnModel {
  std::function<Answer(const mechanics::StepLimits&)> solve;
  bool is_solved; ///< nothing is left by iterations
  bool is_of_elements = false;
};

OwnModel springs_of(const cases::Scene& scene) {
  return {[&scene](const mechanics::StepLimits& limits) {
            std::optional<msm::DesignResult> design;
            return solve_springs(scene, 1, design, limits);
          },
          !has_iteration_limit(scene.definition.msm)};
}

OwnModel elements_of(const cases::Scene& scene) {
  return {[&scene](const mechanics::StepLimits& limits) {
            return solve_stepped_fem(scene, fem_reference::StepBy::method, limits);
          },
          false, true};
}

/// @param answer  of stepped elements
ErrorBudget parts_of_elements(const Basis& basis, const Answer& answer, const std::string& measure) {
  Answers stepped = basis.fem;
  stepped.fem = answer;
  stepped.resolved = basis.scene.definition.fem;
  Comparison compared = compare_sides(basis.scene, basis.fem, Answers{});
  compared.answers = std::move(stepped);
  return budget_of_stepped_elements(compared, measure);
}

/// What holds for clients holds for our steps in real time: a limit on wall-clock time, and mean places of a
/// body that still moves at the end.
JudgedRow own_row(const Basis& basis, const OwnModel& model, const ClientBudget& budget) {
  std::optional<mechanics::CameToRest> moving;
  bool is_late = false;
  mechanics::StepLimits limits;
  limits.should_stop = [&, stopwatch = Stopwatch()] {
    return is_late = stopwatch.seconds() > budget.seconds;
  };
  limits.tell_moving = [&](const mechanics::CameToRest& body) { moving = body; };
  const Answer answer = model.solve(limits);
  JudgedRow row = row_of(springs_model, basis, answer, model.is_solved);
  if (row.parts && model.is_of_elements && !basis.scene.definition.dynamics)
    row.parts = parts_of_elements(basis, answer, row.worst_at);
  if (is_late) row.failure += fmt::format(": it took longer than {:g} s", budget.seconds);
  row.milliseconds_a_step = milliseconds_a_step(answer);
  if (moving && row.failure.empty()) {
    row.is_at_rest = false;
    row.warnings.push_back(describe_moving(moving->time, moving->mean_from));
    row.milliseconds_a_step = 1e3 * answer.solve_seconds / static_cast<double>(moving->steps);
  }
  if (const auto& from = answer.solution.from_equilibrium; from && from->rest)
    row.rests_after = from->rest->time;
  return row;
}

JudgedRow stepped_row(const Basis& basis, const Steps& steps, const ClientBudget& budget) {
  cases::Scene scene = basis.scene;
  const std::string name = name_of(method_of(steps));
  JudgedRow row{name};
  std::vector<std::string> ignored;
  try {
    if (!scene.definition.material_dynamics.density)
      throw cases::InputError("the case has no material.density, which steps in time need");
    const bool is_of_springs = std::holds_alternative<cases::RealTime>(steps);
    ignored = is_of_springs ? set_steps(scene.definition, std::get<cases::RealTime>(steps))
                            : set_steps(scene, std::get<cases::ElementRealTime>(steps));
    row = own_row({scene, basis.fem, basis.parts, basis.lattices},
                  is_of_springs ? springs_of(scene) : elements_of(scene), budget);
  } catch (const cases::InputError& error) {
    row.failure = error.what();
  }
  row.model = name;
  row.client = Introduction{"springproof", program_version(), name,
                            settings_of(steps, scene.definition).dump(), ignored};
  return row;
}

JudgedRow client_row(const Basis& basis, const Client& client, const ClientBudget& budget) {
  const cases::Scene& scene = basis.scene;
  const ClientAnswer found = ask_client(scene, client, budget);
  JudgedRow row = row_of(client.name, basis, found.answer, false);
  if (row.parts && (!found.introduction || !found.introduction->unsupported.empty()))
    row.parts = without_parts(row.worst_at,
                              "it ignores something of the scene, so that its springs may have another law");
  else if (row.parts && row.parts->reason.empty())
    row.parts->step = {std::nullopt, 0, "counted with the iterations"};
  row.client = found.introduction;
  row.command = shell_line(client.words);
  row.warnings.insert(row.warnings.end(), found.warnings.begin(), found.warnings.end());
  row.is_at_rest = found.is_at_rest;
  if (row.failure.empty() && !scene.definition.dynamics && found.is_at_rest)
    row.rests_after = found.model_time;
  row.milliseconds_a_step = found.milliseconds_a_step();
  row.residual.reset(); // its own is not known
  return row;
}

} // namespace

std::string JudgedRow::status() const {
  if (!failure.empty()) return "failed";
  return is_at_rest ? "answered" : "moving";
}

bool JudgedCase::has_failed() const {
  return std::any_of(rows.begin(), rows.end(),
                     [](const JudgedRow& row) { return row.status() != "answered"; });
}

Judge::Judge(cases::Scene scene, int meshes, Parts parts) : scene_(std::move(scene)), parts_(parts) {
  cases::refuse_tools(scene_.definition, "judge and league", "the protocol of clients has no tools");
  cases::refuse_network(scene_.definition, "judge and league, whose programs are told cells",
                        "run solves the springs of the network");
  if (scene_.definition.measures.empty())
    throw cases::InputError(scene_.definition.file + ": judge: the case has no [[measure]]; add one");
  fem_ = solve_reference(scene_, meshes);
  if (parts == Parts::left_out || scene_.definition.dynamics || !fem_.fem.converged()) return;
  Answers springs;
  springs.msm = solve_springs(scene_, 1, springs.design);
  if (springs.msm.converged())
    lattices_.emplace(compare_sides(scene_, fem_, springs), Request{std::nullopt, meshes});
}

const SpringLattices* Judge::lattices() const {
  return lattices_ ? &*lattices_ : nullptr;
}

JudgedCase Judge::own(const ClientBudget& budget) const {
  JudgedCase judged{scene_.definition.name, scene_.definition.dynamics.has_value(), false, {}};
  judged.rows = {fem_row({scene_, fem_, parts_, lattices()}),
                 own_row({scene_, fem_, parts_, lattices()}, springs_of(scene_), budget)};
  for (JudgedRow& row : judged.rows) {
    say_whether_in_time(row, scene_, budget);
    for (const MeasuredValue& one : row.measures)
      judged.is_converged = judged.is_converged || one.fem_limit.has_value();
  }
  return judged;
}

JudgedRow Judge::ask(const Client& client, const ClientBudget& budget) const {
  JudgedRow row = client_row({scene_, fem_, parts_, lattices()}, client, budget);
  say_whether_in_time(row, scene_, budget);
  return row;
}

JudgedRow Judge::step(const Steps& steps, const ClientBudget& budget) const {
  JudgedRow row = stepped_row({scene_, fem_, parts_, lattices()}, steps, budget);
  say_whether_in_time(row, scene_, budget);
  return row;
}

JudgedCase judge_clients(const cases::Scene& scene, const std::vector<NamedMethod>& methods,
                         const std::vector<Client>& clients, const ClientBudget& budget, int meshes) {
  const Judge judge(scene, meshes);
  JudgedCase judged = judge.own(budget);
  for (const NamedMethod& method : methods) {
    judged.rows.push_back(judge.step(method.steps, budget));
    judged.rows.back().model = method.name;
  }
  for (const Client& client : clients) judged.rows.push_back(judge.ask(client, budget));
  return judged;
}

Json row_to_json(const JudgedRow& row) {
  Json json{{"model", row.model},
            {"status", row.status()},
            {"error_percent", row.worst},
            {"error_uncertainty", row.bar},
            {"at", text_or_null(row.worst_at)},
            {"volume_percent", row.volume},
            {"milliseconds_a_step", row.milliseconds_a_step},
            {"in_real_time", row.in_real_time},
            {"rests_after", row.rests_after},
            {"residual_percent", row.residual ? Json(100 * *row.residual) : Json()},
            {"reason", text_or_null(row.failure)},
            {"command", text_or_null(row.command)}};
  if (!row.chosen.empty()) json["chosen"] = row.chosen;
  if (row.parts) json["parts"] = error_budget_to_json(*row.parts);
  json["keeps_60_hz"] =
      row.milliseconds_a_step ? Json(*row.milliseconds_a_step <= milliseconds_a_picture) : Json();
  json["surface"] = row.surface ? surface_to_json(*row.surface) : Json();
  if (row.client) {
    json["client"] = {{"name", row.client->name},
                      {"version", row.client->version},
                      {"method", row.client->method},
                      {"settings", Json::parse(row.client->settings, nullptr, false)},
                      {"unsupported", row.client->unsupported}};
    if (json["client"]["settings"].is_discarded()) json["client"]["settings"] = row.client->settings;
    json["ignored"] = row.client->unsupported.size();
  }
  json["warnings"] = row.warnings;
  json["measures"] = json_list(row.measures, [&](const MeasuredValue& one) {
    return Json{{"measure", one.name},
                {"unit", one.unit},
                {"value", row.model == fem_model ? one.fem : one.msm},
                {"error_percent", one.error_percent}};
  });
  return json;
}

std::vector<std::string> notes_of(const JudgedRow& row) {
  std::vector<std::string> notes;
  if (!row.failure.empty()) notes.push_back(fmt::format("{} failed: {}", row.model, row.failure));
  for (const std::string& warning : row.warnings) notes.push_back(fmt::format("{}: {}", row.model, warning));
  if (row.parts && !row.parts->reason.empty())
    notes.push_back(fmt::format("{}: no parts of its error: {}", row.model, row.parts->reason));
  if (!row.client) return notes;
  const Introduction& client = *row.client;
  notes.push_back(fmt::format("{}: {} {}, {}; {}", row.model, client.name, client.version, client.method,
                              client.settings));
  if (!client.unsupported.empty())
    notes.push_back(fmt::format("{} ignores {}", row.model, fmt::join(client.unsupported, "; ")));
  return notes;
}

Json judged_to_json(const std::vector<JudgedCase>& cases, const ClientBudget& budget) {
  Json list = Json::array();
  for (const JudgedCase& judged : cases)
    list.push_back({{"case", judged.name},
                    {"reference", judged.is_converged ? "limit" : "finite elements"},
                    {"rows", json_list(judged.rows, row_to_json)}});
  return {{"schema", 1},
          {"budget", {{"step", budget.step}, {"iterations", budget.iterations}, {"end", budget.model_time}}},
          {"cases", list}};
}

namespace {

/// The status in place of what it leaves empty.
Json row_of_text(const JudgedRow& row) {
  Json json = row_to_json(row);
  if (!row.failure.empty()) json["error_percent"] = row.status();
  if (row.failure.empty() && !row.is_at_rest) json["rests_after"] = row.status();
  return json;
}

} // namespace

void write_judged_text(std::ostream& out, const JudgedCase& judged) {
  write_wrapped(out,
                fmt::format("{}: worst errors of the measures from the finite elements{}", judged.name,
                            judged.is_converged ? "' limit" : " on the same mesh (--converge: their limit)"),
                2);
  const bool has_surface = std::any_of(judged.rows.begin(), judged.rows.end(),
                                       [](const JudgedRow& row) { return row.surface.has_value(); });
  const std::string error = "model error~%=error_percent{:.2f} +-=error_uncertainty{:.2f} at{:<} ",
                    of_motion = "surface~%=surface.error_percent{:.2f} left~%=residual_percent{:.2g} ",
                    others = "volume~%=volume_percent{:.2f} rests~s=rests_after{:.2f} ignores=ignored ",
                    pace = "ms~a~step=milliseconds_a_step{:.2f} real~time=in_real_time";
  write_table(out,
              columns_of(error + (has_surface ? of_motion : others) + pace +
                         (has_surface ? " 60~Hz=keeps_60_hz" : "")),
              json_list(judged.rows, row_of_text));
  for (const JudgedRow& row : judged.rows)
    for (const std::string& note : notes_of(row)) write_wrapped(out, "    " + note, 6);
}

void write_judged_csv(std::ostream& out, const std::vector<JudgedCase>& cases) {
  Json rows = Json::array();
  for (const JudgedCase& judged : cases)
    for (const JudgedRow& row : judged.rows) {
      Json json = row_to_json(row);
      json["case"] = judged.name;
      rows.push_back(json);
    }
  write_csv(out,
            columns_of("case model status error_percent error_uncertainty at volume_percent "
                       "surface_percent=surface.error_percent residual_percent rests_after "
                       "milliseconds_a_step keeps_60_hz in_real_time ignored reason command"),
            rows);
}

} // namespace springproof::compare
