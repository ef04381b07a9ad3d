#include "cases/case/names.hpp"
#include "compare/cube/write_design.hpp"
#include "compare/dossier/gate_list.hpp"
#include "compare/error_bars/auto_fem.hpp"
#include "compare/write/write.hpp"
#include "mechanics/larger.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace springproof::compare {

namespace {

/// The least and the largest of some values; nothing of none.
class ValueExtent {
 public:
  void add(double value) {
    if (!std::isfinite(value)) return;
    lowest_ = lowest_ ? std::min(*lowest_, value) : value;
    highest_ = highest_ ? std::max(*highest_, value) : value;
  }
  std::optional<double> lowest() const { return lowest_; }
  std::optional<double> highest() const { return highest_; }
  bool holds(double value) const { return lowest_ && *lowest_ <= value && value <= *highest_; }
  bool is_empty() const { return !lowest_; }
  Json to_json() const { return lowest_ ? Json{*lowest_, *highest_} : Json(); }

 private:
  std::optional<double> lowest_, highest_;
};

/// Principal logarithmic strains of the cells.
ValueExtent strains_of(const cases::Solution& solution) {
  ValueExtent extent;
  if (solution.status != cases::Status::converged || !solution.fields) return extent;
  for (const cases::SymmetricTensor& strain : solution.fields->strain) {
    extent.add(component_of(strain, cases::TensorComponent::principal_1));
    extent.add(component_of(strain, cases::TensorComponent::principal_3));
  }
  return extent;
}

ValueExtent poissons_ratios_of(const cases::Case& definition) {
  ValueExtent extent;
  for (const cases::Material& material : cases::materials_of(definition))
    if (cases::is_isotropic(material)) extent.add(cases::poissons_ratio_of(material));
  return extent;
}

/// The largest displacement gradient of an answer; of a motion that of all the times when its body is kept.
double largest_gradient_of(const cases::Scene& scene, const cases::Solution& solution) {
  double largest = largest_gradient(scene.mesh, solution.displacement);
  if (solution.trajectory)
    for (const auto& body : solution.trajectory->bodies)
      largest = mechanics::larger(largest, largest_gradient(scene.mesh, body.displacement));
  return largest;
}

Json side_to_json(const cases::Scene& scene, const Answer& answer, const ValueExtent& strains) {
  const cases::Solution& solution = answer.solution;
  return {{"strain", strains.to_json()},
          {"largest_gradient", answer.converged() ? Json(largest_gradient_of(scene, solution)) : Json()},
          {"inverted_cells", solution.inverted_cells}};
}

/// The range in which the springs' lattice is stable, beside the stretches of the case.
Json stability_to_json(const Comparison& comparison, const ValueExtent& strains) {
  const Json springs = springs_of_case(comparison);
  if (springs.is_null() || !springs.contains("stability") || springs["stability"].is_null()) return nullptr;
  Json range = springs["stability"];
  if (!strains.is_empty() && range.contains("stretch") && range.contains("compression"))
    range["holds_strains"] = range["compression"].get<double>() <= std::exp(*strains.lowest()) &&
                             std::exp(*strains.highest()) <= range["stretch"].get<double>();
  return range;
}

} // namespace

Json applicability_to_json(const StudiedCase& studied, const Dossier& dossier, MissingList& missing) {
  const Comparison& comparison = studied.comparison;
  const cases::Scene& scene = comparison.scene;
  const cases::Case& definition = scene.definition;
  const Answers& answers = comparison.answers;
  const ValueExtent fem = strains_of(answers.fem.solution), msm = strains_of(answers.msm.solution),
                    ratios = poissons_ratios_of(definition);
  ValueExtent verified, verified_strains;
  for (const Comparison& own : dossier.code.cases) {
    const ValueExtent of_case = poissons_ratios_of(own.scene.definition);
    if (!of_case.is_empty()) {
      verified.add(*of_case.lowest());
      verified.add(*of_case.highest());
    }
    if (own.answers.fem.converged())
      verified_strains.add(largest_gradient_of(own.scene, own.answers.fem.solution));
  }
  std::vector<std::string> outside;
  if (!ratios.is_empty() && !(verified.holds(*ratios.lowest()) && verified.holds(*ratios.highest())))
    outside.push_back(*ratios.lowest() == *ratios.highest()
                          ? fmt::format("Poisson's ratio {:g}", *ratios.lowest())
                          : fmt::format("Poisson's ratio {:g} to {:g}", *ratios.lowest(), *ratios.highest()));
  Json sides{{"fem", side_to_json(scene, answers.fem, fem)}, {"msm", side_to_json(scene, answers.msm, msm)}};
  const Json& gradient = sides["fem"]["largest_gradient"];
  if (!gradient.is_null() && !verified_strains.is_empty() &&
      gradient.get<double>() > *verified_strains.highest())
    outside.push_back(fmt::format("displacement gradients up to {:.2g}", gradient.get<double>()));
  for (const std::string& what : outside)
    missing.add("applicability", definition.name, "a case of the program's own that reaches " + what,
                "a gate of kind exact or peer there");
  if (fem.is_empty())
    missing.add("applicability", definition.name,
                "the strains of the finite elements: there are none of cells",
                "a static case whose finite elements converge");
  std::vector<std::string> warnings = warnings_of(comparison);
  if (definition.dynamics)
    for (std::string& note : notes_on_motion(comparison)) warnings.push_back(std::move(note));
  Json json{{"case", definition.name}, {"cells", cases::name_of(scene.mesh.shape)}};
  json["body"] = body_to_json(scene);
  json["poissons_ratio"] = ratios.to_json();
  json["verified_poissons_ratio"] = verified.to_json();
  json["verified_gradient"] = verified_strains.highest();
  json["outside"] = outside;
  json.update(sides);
  json["stability"] = stability_to_json(comparison, msm);
  json["choices"] = answers.choices;
  json["warnings"] = warnings;
  json["doubts"] = comparison.doubts();
  return json;
}

} // namespace springproof::compare
