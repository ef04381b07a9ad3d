#pragma once

#include "cases/case/case.hpp"
#include "cases/case/toml_table.hpp"

/// What a case says of time and of masses.
namespace springproof::cases {

/// [dynamics], where there is one.
std::optional<Dynamics> read_dynamics(Table& root);

/// density, mass_damping and stiffness_damping of a material's table.
MaterialDynamics read_material_dynamics(Table& table, bool has_dynamics);

/// history of a load or motion; the key is refused in a static case.
History read_history(Table& table, bool has_dynamics);

/// over_time of a measure.
std::optional<OverTime> read_over_time(Table& table, MeasureKind kind, bool has_dynamics);

/// Checks a case that is read but for what is below it: densities where masses are asked for, motions that
/// have a beginning, and what a motion does not have.
void check_dynamics(Table& root, const Case& definition);

} // namespace springproof::cases
