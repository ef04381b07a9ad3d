#include "fem_reference/grid/on_grid.hpp"

#include "mechanics/laws/principal_stress.hpp"

#include <algorithm>

namespace springproof::fem_reference::grid {

namespace {

constexpr std::size_t most_terms = 8; ///< in Ogden's law

} // namespace

#pragma GCC diagnostic error "-Wswitch" // a formulation without its law must not compile
Law law_of(cases::Formulation formulation) {
  switch (formulation) {
  case cases::Formulation::small_strain:
    return Law::small_strain;
  case cases::Formulation::saint_venant_kirchhoff:
    return Law::saint_venant_kirchhoff;
  case cases::Formulation::log_strain:
    return Law::log_strain;
  case cases::Formulation::hyperelastic:
    break;
  }
  return Law::ogden;
}

std::vector<double> parameters_of(const cases::Material& material) {
  if (const auto* elastic = std::get_if<cases::LinearElastic>(&material))
    return mechanics::parameters_of(*elastic).value;
  return mechanics::parameters_of(std::get<cases::Ogden>(material)).value;
}

mechanics::ElasticModuli moduli_at_rest(const cases::Material& material) {
  if (const auto* elastic = std::get_if<cases::LinearElastic>(&material))
    return mechanics::elastic_moduli(*elastic);
  return mechanics::elastic_moduli(cases::hyperelastic_rest(material).value());
}

bool is_on_grid(const cases::Scene& scene) {
  const cases::Fem& fem = scene.definition.fem;
  if (!scene.mesh.grid || !scene.definition.tools.empty()) return false;
  if (fem.element == cases::Element::q2_p1) return false;
  if (scene.definition.dynamics && fem.element == cases::Element::q2) return false; // has no masses there
  if (cases::has_memory(scene.definition)) return false;
  std::size_t n_parameters = 0;
  for (const cases::Material& material : cases::materials_of(scene.definition)) {
    if (std::holds_alternative<cases::TransverselyIsotropic>(material) ||
        std::holds_alternative<cases::Yeoh>(material))
      return false;
    if (std::holds_alternative<cases::Ogden>(material) !=
        (fem.formulation == cases::Formulation::hyperelastic))
      return false; // the other backend has the message
    const std::size_t n = parameters_of(material).size();
    if (n > 1 + 2 * most_terms || (n_parameters > 0 && n != n_parameters)) return false;
    n_parameters = n;
  }
  return fem.formulation != cases::Formulation::saint_venant_kirchhoff ||
         (fem.element != cases::Element::q1_bbar && fem.element != cases::Element::q1_p0);
}

double bulk_over_shear(const cases::Scene& scene) {
  double largest = 0;
  for (const cases::Material& material : cases::materials_of(scene.definition)) {
    const mechanics::ElasticModuli moduli = moduli_at_rest(material);
    largest = std::max(largest, moduli.kappa / moduli.mu);
  }
  return largest;
}

} // namespace springproof::fem_reference::grid
