#pragma once

#include "cases/case/hard_case.hpp"
#include "cases/case/toml_table.hpp"

/// The readers of a case file's sections, which read_case() puts together. Each checks what it reads.
namespace springproof::cases {

/// A region under `region`, or a point under `near`.
Region read_region(Table& table, const Body& body);
/// A region in a text: "z+ x-", "near 5 5 10", or the name of a physical group.
Region read_region_text(const Entry& entry, const Body& body);
/// How many faces of a box meet in the region: 1 a face, 2 an edge, 3 a vertex; 0 for a point.
int n_box_faces(const Region& region);

Material read_material(Table& table);
/// [[region_material]]: a material and which cells have it.  @param own  the body's material
RegionMaterial read_region_material(Table& table, const Material& own, const Body& body);
/// What the element and the design ask of every material.  @throws InputError
void check_region_materials(const Case& definition);
/// @throws InputError if the material has no meaning in the element, or for the springs' design
void check_element(const Fem& fem, const Material& material, const Where& where);
void check_design_ratio(const Msm& msm, const Material& material, const Where& where);
/// Automatic choices need expectations that ask for an accuracy.
void check_accuracy(Table& root, const Case& definition);

Fixed read_fixed(Table& table, const Body& body);
Fixed read_symmetry(Table& table, const Body& body);
Moved read_moved(Table& table, const Body& body);
Load read_load(Table& table, const Body& body);

Fem read_fem(Table& table, const Material& material, const Body& body);
Msm read_msm(Table& table, const Material& material);

/// [stress] of a hard case, into everything but its definition.
void read_stress(Table& table, HardCase& result);

Measure read_measure(Table& table, const Body& body);
Expectation read_expectation(Table& table, const std::vector<Measure>& measures);

} // namespace springproof::cases
