#pragma once

#include "cases/case/case.hpp"

#include <string>

/// What of an element decides where it may be used.
namespace springproof::cases {

struct ElementFacts {
  Element element;
  bool is_tetrahedron;   ///< else a hexahedron
  int degree;            ///< the displacement's
  bool has_pressure;     ///< averages the volume of a cell or has its pressure as an unknown
  int order;             ///< the highest in which displacements of points converge in h
  bool is_mixed = false; ///< its pressure is a field of the whole body, which no cell can condense
};

const ElementFacts& facts_of(Element element);

/// The elements of a shape that a formulation has, and that a method of real_time takes, the default first.
/// The pressure of a mixed or averaged
/// element acts on the volume ratio J; Saint Venant-Kirchhoff's law S = lambda tr(E) I + 2 mu E has no such
/// part, so there is nothing to average in it.
std::vector<Element> elements_of(const Fem& fem, bool is_tetrahedron);

/// The element of a case that names none.
/// @param materials  with nearly incompressible ones among them tetrahedra have a pressure
Element default_element(const Fem& fem, const std::vector<Material>& materials, bool is_tetrahedron);

/// Gives a case that names no element the default of its mesh's shape.
/// @throws InputError if it names an element of the other shape, or one that its dampers do not go with
void settle_element(Case& definition, bool is_tetrahedron);

/// What the real_time of elements must be with a material that a method does not take; empty: it takes it.
std::string steps_needed(ElementMethod method, const Material& material);

/// Whether elements without a pressure lock so badly with a material that they are refused.
bool needs_pressure(const Material& material);

} // namespace springproof::cases
