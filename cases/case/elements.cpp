#include "cases/case/elements.hpp"

#include "cases/case/error.hpp"
#include "cases/case/names.hpp"

#include <algorithm>
#include <array>

namespace springproof::cases {

namespace {

using E = Element;

/// The order of an element with one constant pressure is that of its pressure's error squared. The first of a
/// shape are the defaults.
constexpr std::array<ElementFacts, 10> table{{{E::q1_bbar, false, 1, true, 2},
                                              {E::q1, false, 1, false, 2},
                                              {E::q1_p0, false, 1, true, 2},
                                              {E::q1_wilson, false, 1, false, 2},
                                              {E::q2, false, 2, false, 4},
                                              {E::q2_p1, false, 2, true, 4},
                                              {E::p2, true, 2, false, 4},
                                              {E::p1, true, 1, false, 2},
                                              {E::p2_p0, true, 2, true, 2},
                                              {E::p2_p1, true, 2, true, 4, true}}};

/// Poisson's ratio from which tetrahedra of degree 2 have a pressure by default.
constexpr double nearly_incompressible = 0.49;

} // namespace

const ElementFacts& facts_of(Element element) {
  return *std::find_if(table.begin(), table.end(), [=](const auto& row) { return row.element == element; });
}

namespace {

/// Whether a method of steps takes an element. A law as a function of places has no unknowns of cells; of the
/// corotational method cells have a constant matrix, in which the mean volume is condensed.
bool takes(ElementMethod method, const ElementFacts& facts) {
#pragma GCC diagnostic error "-Wswitch" // a method that is forgotten here must not compile
  switch (method) {
  case ElementMethod::corotational:
    return facts.element == E::q1_bbar || facts.element == E::q1 || facts.element == E::p1;
  case ElementMethod::total_lagrangian_explicit:
    return facts.element == E::q1 || facts.element == E::p1;
  case ElementMethod::xpbd:
    break;
  }
  return facts.element == E::p1;
}

} // namespace

std::vector<Element> elements_of(const Fem& fem, bool is_tetrahedron) {
  std::vector<Element> found;
  for (const ElementFacts& row : table)
    if (row.is_tetrahedron == is_tetrahedron &&
        !(row.has_pressure && fem.formulation == Formulation::saint_venant_kirchhoff) &&
        (!fem.real_time || takes(fem.real_time->method, row)))
      found.push_back(row.element);
  return found;
}

Element default_element(const Fem& fem, const std::vector<Material>& materials, bool is_tetrahedron) {
  const bool has_pressure = fem.formulation != Formulation::saint_venant_kirchhoff;
  if (fem.real_time) return elements_of(fem, is_tetrahedron).front();
  if (!is_tetrahedron) {
    if (fem.formulation == Formulation::hyperelastic) return Element::q1_p0; // the name of a law in stretches
    return elements_of(fem, false).front();
  }
  const bool is_stiff = std::any_of(materials.begin(), materials.end(), [](const Material& material) {
    return is_isotropic(material) && poissons_ratio_of(material) >= nearly_incompressible;
  });
  return has_pressure && is_stiff ? Element::p2_p0 : Element::p2;
}

namespace {

/// Refuses a Prony series that the finite elements' stress cannot have.
void check_memory(const Case& definition) {
  const Fem& fem = definition.fem;
  bool has_k = false, are_equal = true;
  for (std::size_t m = 0; m <= definition.region_materials.size(); ++m)
    for (const PronyTerm& term : dynamics_of(definition, m).prony) {
      has_k = has_k || term.k > 0;
      are_equal = are_equal && term.g == term.k;
    }
  if (fem.formulation == Formulation::saint_venant_kirchhoff && !are_equal)
    refuse(fem.where,
           "formulation is \"{}\", whose stress has no separate pressure: material.prony must have k "
           "equal to g beside it",
           name_of(fem.formulation));
  if ((fem.element == Element::q2_p1 || fem.element == Element::p2_p1) && has_k)
    refuse(fem.where,
           "element is \"{}\", whose pressure is linear and has no memory: material.prony must have "
           "k = 0 beside it, or take another element",
           name_of(fem.element));
}

} // namespace

void settle_element(Case& definition, bool is_tetrahedron) {
  Fem& fem = definition.fem;
  if (facts_of(fem.element).is_mixed && has_stiffness_damping(definition))
    refuse(
        fem.where,
        "element is \"{}\", must be \"{}\" or one without a pressure beside stiffness_damping: dampers are "
        "of single cells, and its pressure is of the whole body",
        name_of(fem.element), name_of(Element::p2_p0));
  if (facts_of(fem.element).is_tetrahedron != is_tetrahedron && fem.has_auto_element &&
      !elements_of(fem, is_tetrahedron).empty())
    fem.element = default_element(fem, materials_of(definition), is_tetrahedron);
  check_memory(definition);
  if (facts_of(fem.element).is_tetrahedron == is_tetrahedron) return;
  const char* const cells = is_tetrahedron ? "tetrahedra" : "hexahedra";
  const std::vector<Element> allowed = elements_of(fem, is_tetrahedron);
  if (allowed.empty())
    refuse(fem.where,
           "real_time.method is \"{}\", must be \"{}\" | \"{}\": the body is a mesh of {}, and its "
           "constraints are of tetrahedra, which would be another mesh",
           name_of(fem.real_time->method), name_of(ElementMethod::corotational),
           name_of(ElementMethod::total_lagrangian_explicit), cells);
  refuse(fem.where, "element is \"{}\", must be {}: the body is a mesh of {}", name_of(fem.element),
         alternatives(allowed), cells);
}

std::string steps_needed(ElementMethod method, const Material& material) {
  const std::string model = name_of(material);
  if (!has_law_of_case(method) && model != LinearElastic::name)
    return "of method = \"" + name_of(ElementMethod::total_lagrangian_explicit) + "\" with model = \"" +
           model + "\": the laws of the others are those of \"" + LinearElastic::name + "\" materials";
  return needs_pressure(material)
             ? "left out with model = \"" + model + "\" without bulk_modulus: its elements have no pressure"
             : "";
}

bool needs_pressure(const Material& material) {
  const auto rest = hyperelastic_rest(material);
  return rest && !rest->bulk_modulus;
}

} // namespace springproof::cases
