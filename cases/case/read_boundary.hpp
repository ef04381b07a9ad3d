#pragma once

#include "cases/case/case.hpp"
#include "cases/case/toml_table.hpp"

/// Regions, supports, motions and loads of a case file.
namespace springproof::cases {

/// A region under `region`, or a point under `near`.
Region read_region(Table& table, const Body& body);
/// A region in a text: "z+ x-", "near 5 5 10", or the name of a physical group.
Region read_region_text(const Entry& entry, const Body& body);
/// How many faces of a box meet in the region: 1 a face, 2 an edge, 3 a vertex; 0 for a point.
int n_box_faces(const Region& region);

Fixed read_fixed(Table& table, const Body& body);
Fixed read_symmetry(Table& table, const Body& body);
Moved read_moved(Table& table, const Body& body);
Load read_load(Table& table, const Body& body);

} // namespace springproof::cases
