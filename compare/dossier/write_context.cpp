#include "cases/case/input_file.hpp"
#include "cases/case/names.hpp"
#include "compare/dossier/gate_list.hpp"
#include "compare/solve/kept.hpp"
#include "compare/table/table.hpp"
#include "compare/write/write.hpp"

#include <array>
#include <fmt/format.h>

namespace springproof::compare {

namespace {

Json material_to_json(const cases::Material& material) {
  return std::visit(
      [](const auto& m) -> Json {
        using Model = std::decay_t<decltype(m)>;
        Json json{{"model", Model::name}};
        if constexpr (std::is_same_v<Model, cases::LinearElastic>)
          json.update(SPRINGPROOF_MEMBERS(m, youngs_modulus, poissons_ratio));
        else if constexpr (std::is_same_v<Model, cases::Ogden>)
          json.update(SPRINGPROOF_MEMBERS(m, mu, alpha, bulk_modulus));
        else if constexpr (std::is_same_v<Model, cases::Yeoh>)
          json.update(SPRINGPROOF_MEMBERS(m, c10, c20, c30, bulk_modulus));
        else
          json.update(SPRINGPROOF_MEMBERS(m, youngs_modulus_along, youngs_modulus_across,
                                          poissons_ratio_along, poissons_ratio_across, shear_modulus_along));
        return json;
      },
      material);
}

/// Materials with what they add to their elasticity.
Json materials_to_json(const cases::Case& definition) {
  const std::vector<cases::Material> materials = cases::materials_of(definition);
  Json all = Json::array();
  for (std::size_t m = 0; m < materials.size(); ++m) {
    const cases::MaterialDynamics& dynamics = cases::dynamics_of(definition, m);
    all.push_back(material_to_json(materials[m]));
    all.back().update(SPRINGPROOF_MEMBERS(dynamics, density, mass_damping, stiffness_damping));
    all.back()["prony"] = json_list(
        dynamics.prony, [](const cases::PronyTerm& term) { return SPRINGPROOF_MEMBERS(term, g, k, tau); });
  }
  return all;
}

Json tool_to_json(const cases::Tool& tool) {
  const auto vector = [](const Eigen::Vector3d& v) { return Json::array({v.x(), v.y(), v.z()}); };
  const bool is_on_path = !tool.path.empty();
  return {{"name", tool.name},
          {"shape", cases::name_of(tool.shape)},
          {"at_mm", is_on_path ? Json() : vector(tool.at)},
          {"displacement_mm", is_on_path ? Json() : vector(tool.displacement)},
          {"path", is_on_path ? Json(tool.path) : Json()},
          {"friction", tool.friction}};
}

std::string kind_of(const cases::Measure& measure) {
  return std::visit([](const auto& kind) { return std::string(kind.name); }, measure.kind);
}

Json context_of_case(const StudiedCase& studied, const GateList& gates) {
  const cases::Scene& scene = studied.comparison.scene;
  const cases::Case& definition = scene.definition;
  const Answers& answers = studied.comparison.answers;
  const std::string text = cases::read_text_file(definition.file);
  Json quantities = Json::array();
  for (const cases::Measure& measure : definition.measures)
    quantities.push_back({{"measure", measure.name},
                          {"kind", kind_of(measure)},
                          {"unit", unit_of(measure)},
                          {"gates", gates.names_of(definition.name, measure.name)}});
  return {{"case", definition.name},
          {"description", definition.description},
          {"file", definition.file},
          {"sha256", digest(text)},
          {"text", text},
          {"body", body_to_json(scene)},
          {"materials", materials_to_json(definition)},
          {"loads", loads_to_json(scene)},
          {"tools", json_list(definition.tools, tool_to_json)},
          {"moves", definition.dynamics.has_value()},
          {"fem", fmt::format("{} {}", cases::name_of(answers.resolved.formulation),
                              cases::name_of(answers.resolved.element))},
          {"springs", fmt::format("{}{}", cases::name_of(definition.msm.design),
                                  answers.design ? " with " + springs_text(*answers.design) : "")},
          {"quantities", quantities}};
}

} // namespace

Json context_to_json(const Dossier& dossier, const GateList& gates, MissingList& missing) {
  const DossierContext& context = dossier.context;
  const std::pair<const std::string*, std::array<const char*, 2>> all[]{
      {&context.question, {"the question that the simulation is to answer", "--question TEXT"}},
      {&context.role,
       {"how much the decision rests on the simulation, beside other evidence", "--role TEXT"}},
      {&context.consequence, {"what a wrong answer would do, and to whom", "--consequence TEXT"}}};
  for (const auto& [text, words] : all)
    if (text->empty()) missing.add("context", "", words[0], words[1]);
  Json json{{"question", text_or_null(context.question)},
            {"role", text_or_null(context.role)},
            {"consequence", text_or_null(context.consequence)},
            {"settings", dossier.settings},
            {"cases", Json::array()}};
  for (const StudiedCase& studied : dossier.cases) {
    const cases::Case& definition = studied.comparison.scene.definition;
    if (definition.measures.empty())
      missing.add("context", definition.name, "quantities of interest: the case has no [[measure]]",
                  "a [[measure]] in the case");
    else if (definition.expectations.empty())
      missing.add("context", definition.name, "what is required of the quantities: the case expects nothing",
                  "an [[expect]] of reference \"requirement\" in the case");
    json["cases"].push_back(context_of_case(studied, gates));
  }
  return json;
}

} // namespace springproof::compare
