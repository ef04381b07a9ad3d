#include "cases/case/input_file.hpp"
#include "cases/case/names.hpp"
#include "compare/dossier/gate_list.hpp"
#include "compare/solve/kept.hpp"
#include "compare/table/table.hpp"
#include "compare/write/write.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <map>

namespace springproof::compare {

namespace {

const char* const method =
    "Its sections and factors are named as ASME V&V 40 and V&V 20 name them, in words of our own. None of "
    "their text is here, and this is no claim of compliance with them: whoever hands it in judges whether "
    "it is enough.";

/// A number of a measure with the gates that hold it.
Json numbers_of(const Comparison& comparison, const GateList& gates, const MeasuredValue& m) {
  const std::string& name = comparison.scene.definition.name;
  const auto of = [&](cases::Quantity quantity) { return gates.names_of(name, m.name, quantity); };
  return {{"fem", of(cases::Quantity::fem)},
          {"msm", of(cases::Quantity::msm)},
          {"error_percent", of(cases::Quantity::error_percent)}};
}

/// Another program's values on the same mesh.
void add_peer_rows(const Comparison& comparison, const GateList& gates, Json& rows) {
  const auto& peer = comparison.answers.peer;
  if (!peer) return;
  const std::string& name = comparison.scene.definition.name;
  const Json row{{"case", name},
                 {"program", peer->program},
                 {"status", cases::name_of(peer->answer.solution.status)},
                 {"message", text_or_null(peer->answer.solution.message)},
                 {"compares", "the same mesh"}};
  if (!peer->answer.converged()) rows.push_back(row);
  for (const MeasuredValue& m : comparison.measures) {
    if (!m.peer || !m.fem) continue;
    rows.push_back(row);
    rows.back().update({{"measure", m.name},
                        {"unit", m.unit},
                        {"fem", m.fem},
                        {"peer", m.peer},
                        {"difference_percent", error_percent(*m.fem, *m.peer, 0)},
                        {"within_bars", nullptr},
                        {"gates", gates.names_of(name, m.name, cases::Quantity::fem)}});
  }
}

/// Another program's limits.
void add_peer_rows(const std::string& name, const PeerStudy& study, const GateList& gates, Json& rows) {
  const Json row{{"case", name},
                 {"program", study.program},
                 {"status", cases::name_of(study.status)},
                 {"message", text_or_null(study.message)},
                 {"compares", "limits of both programs' own meshes"}};
  if (study.limits.empty()) rows.push_back(row);
  for (const PeerLimit& limit : study.limits) {
    rows.push_back(row);
    rows.back().update({{"measure", limit.measure},
                        {"unit", limit.unit},
                        {"fem", limit.ours ? Json(limit.ours->value) : Json()},
                        {"fem_uncertainty", limit.ours ? Json(limit.ours->uncertainty) : Json()},
                        {"peer", limit.peer ? Json(limit.peer->value) : Json()},
                        {"peer_uncertainty", limit.peer ? Json(limit.peer->uncertainty) : Json()},
                        {"difference_percent", limit.difference_percent()},
                        {"within_bars", limit.is_within_bars()},
                        {"reason", text_or_null(limit.reason)},
                        {"gates", gates.names_of(name, limit.measure, cases::Quantity::fem)}});
  }
}

void tell_absent_peers(const Json& rows, const std::string& section, MissingList& missing) {
  for (const Json& row : rows)
    if (row["status"] != "converged")
      missing.add(section, row["case"],
                  fmt::format("{}'s answer: {}", row["program"].get<std::string>(),
                              row["message"].is_null() ? "it has none" : row["message"].get<std::string>()),
                  "the program installed, or a case that it has");
}

Json code_to_json(const Dossier& dossier, const GateList& gates, MissingList& missing) {
  const CodeVerification& code = dossier.code;
  Json peers = Json::array();
  for (const Comparison& comparison : code.cases) add_peer_rows(comparison, gates, peers);
  for (const auto& [name, study] : code.second_codes) add_peer_rows(name, study, gates, peers);
  const auto order = [&](const ObservedOrder& one) {
    Json json{{"case", one.case_name}, {"model", one.model}};
    json.update(SPRINGPROOF_MEMBERS(one, measure, unit, values, formal, order));
    json["reason"] = text_or_null(one.reason);
    json["gates"] = one.model == "springs" ? std::vector<std::string>{}
                                           : gates.names_of(one.case_name, one.measure, cases::Quantity::fem);
    return json;
  };
  const auto test = [](const ProjectTest& one) {
    return SPRINGPROOF_MEMBERS(one, part, checked, against, where);
  };
  const auto about = [](const Comparison& one) -> Json {
    return {{"case", one.scene.definition.name}, {"description", one.scene.definition.description}};
  };
  if (code.cases.empty())
    missing.add("code_verification", "", "cases of the program's own whose answer is known",
                "an installation with its folders of cases");
  tell_absent_peers(peers, "code_verification", missing);
  missing.add("code_verification", "", "a run of the project's tests by this build: they are listed, not run",
              "ctest -L verification in the program's build folder");
  return {{"cases", json_list(code.cases, about)},
          {"orders", json_list(code.orders, order)},
          {"peers", peers},
          {"tests", json_list(code.tests, test)}};
}

Json part_of(const std::vector<ErrorBudget>& budgets, const std::string& measure) {
  for (const ErrorBudget& budget : budgets)
    if (budget.measure == measure) return error_budget_to_json(budget);
  return nullptr;
}

Json calculation_of_case(const StudiedCase& studied, const GateList& gates, MissingList& missing) {
  const Comparison& comparison = studied.comparison;
  const std::string& name = comparison.scene.definition.name;
  Json peers = Json::array(), measures = Json::array(), meshes = Json::array();
  std::map<std::string, std::vector<std::string>> without_limit; // measures by the reason
  for (const MeasuredValue& m : comparison.measures) {
    Json row{{"measure", m.name}, {"unit", m.unit}, {"fem", m.fem}, {"msm", m.msm}};
    row["fem_limit"] = m.fem_limit ? Json(m.fem_limit->value) : Json();
    row["fem_limit_uncertainty"] = m.fem_limit ? Json(m.fem_limit->uncertainty) : Json();
    row.update(SPRINGPROOF_MEMBERS(m, error_percent, error_uncertainty_percent, fem_error_percent));
    const StudiedMeasure* mesh_study =
        comparison.mesh_study ? find_named(comparison.mesh_study->measures, m.name) : nullptr;
    row["order"] = mesh_study && mesh_study->limit ? Json(mesh_study->limit->order) : Json();
    const std::string reason = mesh_study ? mesh_study->no_reference : "no limit was asked for";
    row["note"] = m.fem_limit ? text_or_null(m.fem_limit->note) : Json(reason);
    row["gates"] = numbers_of(comparison, gates, m);
    row["parts"] = {{"fem", part_of(studied.budgets.fem, m.name)},
                    {"msm", part_of(studied.budgets.springs, m.name)}};
    if (!m.fem_limit) without_limit[reason].push_back(m.name);
    for (const auto& [model, budgets] :
         {std::pair("springs", &studied.budgets.springs), {"finite elements", &studied.budgets.fem}})
      for (const ErrorBudget& budget : *budgets)
        if (budget.measure == m.name && m.fem_limit && !budget.mesh.percent)
          missing.add("calculation_verification", name,
                      fmt::format("what the {}' own mesh adds to {}: {}", model, m.name,
                                  budget.reason.empty() ? budget.mesh.reason : budget.reason),
                      "a measure and springs that finer lattices have");
    measures.push_back(std::move(row));
  }
  for (const auto& [reason, names] : without_limit)
    missing.add("calculation_verification", name,
                fmt::format("the limit of {} and its error bar: {}", fmt::join(names, ", "), reason),
                comparison.mesh_study ? "loads and supports on areas, or more meshes (--converge=4)"
                                      : "--converge");
  if (const auto& study = comparison.mesh_study)
    for (std::size_t i = 0; i < study->refine.size() && i < study->unknowns.size(); ++i)
      meshes.push_back({{"refine", study->refine[i]}, {"unknowns", study->unknowns[i]}});
  add_peer_rows(comparison, gates, peers);
  if (studied.second_code) add_peer_rows(name, *studied.second_code, gates, peers);
  tell_absent_peers(peers, "calculation_verification", missing);
  if (peers.empty())
    missing.add("calculation_verification", name, "another program's answer to the same case",
                "--peer ccx, --peer getfem");
  return {{"case", name},
          {"meshes", meshes},
          {"lattices", studied.budgets.lattices},
          {"note", text_or_null(studied.budgets.note)},
          {"measures", measures},
          {"fem", side_to_json(comparison.answers.fem)},
          {"msm", side_to_json(comparison.answers.msm)},
          {"peers", peers}};
}

Json inputs_to_json(const StudiedCase& studied) {
  const std::vector<cases::Measure>& measures = studied.comparison.scene.definition.measures;
  Json rows = Json::array();
  for (const InputEffect& effect : studied.inputs)
    for (std::size_t m = 0; m < measures.size(); ++m)
      rows.push_back({{"case", studied.comparison.scene.definition.name},
                      {"key", effect.key},
                      {"value", effect.value},
                      {"standard_uncertainty", effect.deviation},
                      {"measure", measures[m].name},
                      {"unit", unit_of(measures[m])},
                      {"fem", effect.fem[m]},
                      {"msm", effect.msm[m]},
                      {"reason", text_or_null(effect.reason)}});
  return rows;
}

Json model_to_json(const ModelAgainstDatum& model, const std::vector<std::string>& gates) {
  return {{"value", model.value},
          {"difference", model.difference},
          {"numerical", model.numerical.size},
          {"numerical_reason", text_or_null(model.numerical.reason)},
          {"input", model.input},
          {"uncertainty", model.uncertainty},
          {"is_complete", model.is_complete},
          {"reason", text_or_null(model.reason)},
          {"gates", gates}};
}

void tell_missing_of(const ValidatedDatum& row, MissingList& missing) {
  const std::string of = fmt::format("{} (line {})", row.measure, row.line);
  if (!row.deviation)
    missing.add("validation", row.case_name, "the uncertainty of the measurement of " + of,
                "a column \"sigma\" in the data");
  for (const auto& [model, side] : {std::pair("finite elements", &row.fem), {"springs", &row.msm}})
    if (!side->value)
      missing.add("validation", row.case_name, fmt::format("the {}' {}: {}", model, of, side->reason),
                  "a case that is solved");
  const auto tell = [&](const std::string& model, const ModelAgainstDatum& side) {
    if (side.value && !side.numerical.size)
      missing.add("validation", row.case_name,
                  fmt::format("the numerical uncertainty of {}, {}: {}", of, model, side.numerical.reason),
                  "a limit: --converge, and loads on areas");
  };
  if (row.fem.value && row.msm.value && !row.fem.numerical.size && !row.msm.numerical.size &&
      row.fem.numerical.reason == row.msm.numerical.reason)
    return tell("both models", row.fem);
  tell("finite elements", row.fem);
  tell("springs", row.msm);
}

Json validation_to_json(const Dossier& dossier, const GateList& gates, MissingList& missing) {
  const Validation& validation = dossier.validation;
  Json rows = Json::array(), inputs = Json::array();
  for (const ValidatedDatum& datum : validation.data) {
    // A row with settings of its own is another state than the one that the case's gates judge.
    const auto of = [&](cases::Quantity quantity) {
      return datum.settings.empty() ? gates.names_of(datum.case_name, datum.measure, quantity)
                                    : std::vector<std::string>{};
    };
    Json row{{"case", datum.case_name}};
    row.update(SPRINGPROOF_MEMBERS(datum, settings, measure, unit, line));
    row.update({{"datum", datum.value},
                {"standard_uncertainty", datum.deviation},
                {"fem", model_to_json(datum.fem, of(cases::Quantity::fem))},
                {"msm", model_to_json(datum.msm, of(cases::Quantity::msm))}});
    rows.push_back(std::move(row));
    tell_missing_of(datum, missing);
  }
  for (const StudiedCase& studied : dossier.cases) {
    const std::string& name = studied.comparison.scene.definition.name;
    for (Json& row : inputs_to_json(studied)) {
      if (row["fem"].is_null() || row["msm"].is_null())
        missing.add(
            "validation", name,
            fmt::format("what {} does to {}: {}", row["key"].get<std::string>(),
                        row["measure"].get<std::string>(),
                        row["reason"].is_null() ? "it has no value" : row["reason"].get<std::string>()),
            "a smaller standard uncertainty, or a measure with a value");
      inputs.push_back(std::move(row));
    }
    const auto has_data = [&](const ValidatedDatum& datum) { return datum.case_name == name; };
    if (std::none_of(validation.data.begin(), validation.data.end(), has_data))
      missing.add("validation", name, "a measurement of the body, with its uncertainty",
                  "--measured FILE, whose rows are of this case");
  }
  if (!dossier.has_uncertain_keys)
    missing.add("validation", "",
                "what the uncertainty of the inputs (moduli, lengths, loads) does to the measures",
                "--uncertain KEY=SIGMA");
  if (!validation.file.empty() && validation.description.empty())
    missing.add("validation", "", "who measured what, how often and under which conditions",
                "comments (#) at the beginning of " + validation.file);
  return {{"data", text_or_null(validation.file)},
          {"description", text_or_null(validation.description)},
          {"rows", rows},
          {"inputs", inputs},
          {"published", gates.names_of(cases::ReferenceKind::published)}};
}

} // namespace

Json dossier_to_json(const Dossier& dossier) {
  GateList own("springproof/"), gates("");
  MissingList missing;
  for (const Comparison& comparison : dossier.code.cases) own.add(comparison);
  for (const StudiedCase& studied : dossier.cases) gates.add(studied.comparison);
  Json document = provenance();
  document["method"] = method;
  document["context"] = context_to_json(dossier, gates, missing);
  document["code_verification"] = code_to_json(dossier, own, missing);
  document["calculation_verification"] = json_list(dossier.cases, [&](const StudiedCase& studied) {
    return calculation_of_case(studied, gates, missing);
  });
  document["validation"] = validation_to_json(dossier, gates, missing);
  document["applicability"] = json_list(dossier.cases, [&](const StudiedCase& studied) {
    return applicability_to_json(studied, dossier, missing);
  });
  document["gates"] = gates.to_json();
  for (Json& gate : own.to_json()) document["gates"].push_back(std::move(gate));
  document["missing"] = missing.to_json();
  document["is_sound"] = dossier.is_sound();
  return document;
}

} // namespace springproof::compare
