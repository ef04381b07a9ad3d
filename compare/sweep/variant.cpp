#include "compare/sweep/variant.hpp"

#include "cases/case/names.hpp"

#include <fmt/format.h>

namespace springproof::compare {

Family family_of(const Variant& variant) {
  return variant.program == Program::springs ? Family::springs : Family::finite_elements;
}

std::string method_name(const Variant& variant) {
  if (variant.program == Program::springs) return "springs " + cases::name_of(variant.design);
  const std::string name = cases::name_of(variant.formulation) + " " + cases::name_of(variant.element);
  return variant.program == Program::calculix ? "CalculiX " + name : name;
}

std::string cells_name(const std::array<int, 3>& cells) {
  return fmt::format("{}x{}x{}", cells[0], cells[1], cells[2]);
}

std::array<int, 3> field_cells(const Variant& variant) {
  std::array<int, 3> cells = variant.cells;
  if (variant.program == Program::finite_elements && variant.element == cases::Element::q2)
    for (int& n : cells) n *= 2;
  return cells;
}

std::string full_name(const Variant& variant) {
  const std::string name = method_name(variant) + " " + cells_name(variant.cells);
  if (variant.program == Program::calculix) return name;
  return name + fmt::format(" to {:.0e}", variant.tolerance);
}

cases::Case with_variant(const cases::Case& definition, const Variant& variant) {
  cases::Case result = definition;
  std::get<cases::Box>(result.body).cells = variant.cells;
  result.measures.clear();
  result.expectations.clear();
  result.fem.refine = 0;
  if (variant.program == Program::springs) {
    result.msm = {};
    result.msm.design = variant.design;
    result.msm.where = definition.msm.where;
  } else {
    result.fem.formulation = variant.formulation;
    result.fem.element = variant.element;
  }
  return result;
}

} // namespace springproof::compare
