#pragma once

#include "cases/scene/scene.hpp"
#include "fem_reference/grid/kernels.hpp"
#include "mechanics/elastic_moduli.hpp"

#include <vector>

namespace springproof::fem_reference::grid {

/// Whether a scene's body is a grid of cells and its element one of those that the kernels know.
bool is_on_grid(const cases::Scene& scene);

/// The largest ratio of a material's bulk modulus to its shear modulus.
double bulk_over_shear(const cases::Scene& scene);

Law law_of(cases::Formulation formulation);

/// Parameters of the material's law, in the order that Cells asks for.
std::vector<double> parameters_of(const cases::Material& material);

/// Moduli of the material in small strains, the same for each of the kernels' laws.
mechanics::ElasticModuli moduli_at_rest(const cases::Material& material);

} // namespace springproof::fem_reference::grid
