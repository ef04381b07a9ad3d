#pragma once

#include "cases/case/case.hpp"
#include "cases/case/toml_table.hpp"

namespace springproof::cases {

/// A region in a text: "z+ x-", "near 5 5 10", or the name of a physical group.
Region read_region_text(const Entry& entry, const Body& body);

/// A unit vector: "x", "y", "z", or any direction.
Eigen::Vector3d read_direction(const Entry& entry);

/// A region as a table gives it: `region`, a text or a table of a part, or the node nearest to `near`, or
/// with `radius` the patch around it.
Region read_region(Table& table, const Body& body);

/// Reads supports, motions, loads and masses into a case whose body and [dynamics] are read.
void read_boundary(Table& root, Case& result);

/// @throws InputError where nothing holds the body, or nothing moves it
void check_boundary(Table& root, const Case& result);

} // namespace springproof::cases
