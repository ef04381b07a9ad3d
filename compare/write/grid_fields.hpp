#pragma once

#include "cases/mesh/vtk_functions.hpp"
#include "compare/gates/comparison.hpp"

namespace springproof::compare {

/// Both models on the body's mesh at rest, so that "warp by vector" overlays them. Of each side that
/// converged, `fem_` and `msm_`:
///   at nodes  displacement (mm), reaction (N);
///   in cells  cell_volume (mm³), inverted (0 or 1), stress (Cauchy, MPa), von_mises (MPa), strain
///             (logarithmic), strain_energy_density (N mm per mm³ at rest).
/// Of both: difference (vector, springs less finite elements, mm), error (its length, mm), relative_error
/// (over the finite elements' largest displacement) and von_mises_difference (MPa). Of the case:
/// applied_force (N, at nodes, full load; not where a load follows a history), material (number of the cell's
/// [[region_material]], 0: the body's own). Stress, strain and reactions are there when the solutions have
/// fields, stress and energy when their springs belong to cells.
///
/// Where ranks share the answers, of the nodes and cells that are here; the names are the same on every rank.
/// Collective.
cases::GridFields grid_fields_of(const Comparison& comparison);

/// The ranks that share a comparison's answers; null: all of them is here.
const cases::Sharing* sharing_of(const Comparison& comparison);

} // namespace springproof::compare
