#pragma once

#include "cases/case/case.hpp"
#include "cases/case/toml_table.hpp"

/// [material] and [[region_material]].
namespace springproof::cases {

Material read_material(Table& table);
/// A material and the cells that consist of it.  @param own  the body's material
RegionMaterial read_region_material(Table& table, const Material& own, const Body& body);
/// What the element and the design require of every material.  @throws InputError
void check_region_materials(const Case& definition);

} // namespace springproof::cases
