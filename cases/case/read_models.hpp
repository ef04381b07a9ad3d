#pragma once

#include "cases/case/case.hpp"
#include "cases/case/toml_table.hpp"

/// [fem] and [msm].
namespace springproof::cases {

Fem read_fem(Table& table, const Material& material, const Body& body);
Msm read_msm(Table& table, const Material& material);

/// @throws InputError if the material has no meaning in the element
void check_element(const Fem& fem, const Material& material, const Where& where);
/// @throws InputError if the springs' design does not exist for the material
void check_design_ratio(const Msm& msm, const Material& material, const Where& where);
/// Automatic choices need expectations that require an accuracy.  @throws InputError
void check_accuracy(Table& root, const Case& definition);

} // namespace springproof::cases
