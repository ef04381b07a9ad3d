#pragma once

#include "cases/case/case.hpp"
#include "cases/case/toml_table.hpp"

/// What a body consists of: [material] and [[region_material]].
namespace springproof::cases {

/// Names of material.model, in the order of Material.
const std::vector<std::string>& material_models();

/// Poisson's ratio of an isotropic material.
inline constexpr auto is_poissons_ratio = [](double value) { return value > -1 && value < 0.5; };

/// Reads the materials into a case whose body and [dynamics] are read.  @throws InputError
void read_materials(Table& root, Case& result);

} // namespace springproof::cases
