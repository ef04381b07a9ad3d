#pragma once

#include "cases/case/case.hpp"
#include "cases/case/toml_table.hpp"

namespace springproof::cases {

/// [stress] of a hard case.
/// @param msm  the case's springs, whose design gives way to stiffnesses if there are any
Stress read_stress(Table& table, Msm& msm);

} // namespace springproof::cases
