#pragma once

#include "fem_reference/real_time/vertex_elements.hpp"

namespace springproof::fem_reference {

/// Projections of tetrahedra with the law mechanics::NeoHookean, by colours of cells that share no node: the
/// deviatoric part mu/2 |F|² and the hydrostatic one lambda'/2 (J - 1 - mu/lambda')² are a constraint each.
/// Source: Macklin and Mueller, MIG 2021.
/// @param cells  must outlive the method
mechanics::MakeStep make_xpbd(const RestCells& cells, int iterations, int n_threads);

/// The law as a formulation, one for each of the scene's materials.
std::vector<Formulation> neo_hookean(const cases::Scene& scene);

} // namespace springproof::fem_reference
