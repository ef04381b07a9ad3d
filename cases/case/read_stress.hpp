#pragma once

#include "cases/case/hard_case.hpp"
#include "cases/case/toml_table.hpp"

/// [stress] of a hard case.
namespace springproof::cases {

/// Everything of a hard case but its definition.
void read_stress(Table& table, HardCase& result);

} // namespace springproof::cases
