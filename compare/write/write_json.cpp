#include "compare/write/write.hpp"

#include "cases/case/names.hpp"
#include "compare/provenance/machine.hpp"
#include "compare/write/json.hpp"

namespace springproof::compare {

using Json = nlohmann::ordered_json;

namespace {

Json fem_to_json(const Comparison& comparison) {
  Json side = side_to_json(comparison.answers.fem);
  if (!comparison.answers.choices.empty()) side["choices"] = comparison.answers.choices;
  if (comparison.mesh_study) add_mesh_study(side, *comparison.mesh_study);
  return side;
}

Json msm_to_json(const Comparison& comparison) {
  Json side = side_to_json(comparison.answers.msm);
  if (!comparison.answers.msm_source.empty()) { // another program's: how it came by them is not known
    side["source"] = comparison.answers.msm_source;
    for (const char* key :
         {"unknowns", "residual", "newton_iterations", "linear_iterations", "relaxation_iterations"})
      side[key] = nullptr;
    side["seconds"] = {{"setup", nullptr}, {"solve", nullptr}};
  }
  if (comparison.answers.design) {
    const msm::CellStiffness& k = comparison.answers.design->stiffness;
    side["stiffness_N_per_m"] = {1e3 * k.edge, 1e3 * k.face_diagonal, 1e3 * k.internal_diagonal};
    side["volume_stiffness_MPa"] = k.volume;
    side["warnings"] = comparison.answers.design->warnings;
  }
  return side;
}

Json comparison_to_json(const Comparison& comparison) {
  Json measures = Json::array();
  for (const MeasuredValue& m : comparison.measures) {
    measures.push_back({{"name", m.name},
                        {"unit", m.unit},
                        {"fem", m.fem},
                        {"msm", m.msm},
                        {"error_percent", m.error_percent}});
    if (comparison.answers.peer) measures.back()["peer"] = m.peer;
  }
  Json expectations = Json::array();
  for (const Gate& gate : comparison.gates) {
    const Judgement& j = gate.judgement;
    expectations.push_back({{"measure", j.expectation.measure},
                            {"quantity", cases::name_of(j.expectation.quantity)},
                            {"interval", j.expectation.interval},
                            {"reference", cases::name_of(j.expectation.reference)},
                            {"value", j.value},
                            {"met", gate.met()},
                            {"reason", j.reason}});
  }
  const cases::Case& definition = comparison.scene.definition;
  Json document{{"name", definition.name},
                {"description", definition.description},
                {"fem", fem_to_json(comparison)},
                {"msm", msm_to_json(comparison)},
                {"measures", measures},
                {"expectations", expectations},
                {"status", comparison.answers.failed() ? "failed" : "converged"}};
  if (comparison.answers.peer) document["peer"] = to_json(*comparison.answers.peer);
  return document;
}

} // namespace

Json side_to_json(const Answer& side) {
  const cases::Solution& s = side.solution;
  return {{"status", cases::name_of(s.status)},
          {"message", s.message},
          {"unknowns", s.unknowns},
          {"residual", s.residual},
          {"load_reached", s.load_reached},
          {"newton_iterations", s.newton_iterations},
          {"linear_iterations", s.linear_iterations},
          {"relaxation_iterations", s.relaxation_iterations},
          {"force_evaluations", s.force_evaluations},
          {"factorisations", s.factorisations},
          {"lowest_eigenvalue", s.lowest_eigenvalue},
          {"negative_eigenvalues", s.negative_eigenvalues},
          {"inverted_cells", s.inverted_cells},
          {"seconds", {{"setup", side.setup_seconds}, {"solve", side.solve_seconds}}}};
}

Json provenance() {
  const Machine machine = describe_machine();
  return {{"schema", 1},
          {"program", {{"version", program_version()}, {"commit", program_commit()}}},
          {"machine",
           {{"processor", machine.processor},
            {"cores", machine.cores},
            {"system", machine.system},
            {"compiler", machine.compiler},
            {"blas", machine.blas}}}};
}

Json to_json(const std::vector<Comparison>& comparisons) {
  Json document = provenance();
  document["cases"] = Json::array();
  for (const Comparison& comparison : comparisons)
    document["cases"].push_back(comparison_to_json(comparison));
  return document;
}

} // namespace springproof::compare
