#pragma once

#include "fem_reference/constraints.hpp"
#include "fem_reference/geometry.hpp"

namespace springproof::fem_reference {

/// Point forces, tractions, torques and the body force at full load, N per owned degree of freedom.
std::vector<double> assemble_loads(const cases::Scene& scene, const Space& space, const Nodes& nodes,
                                   const Geometry& geometry, const Prescribed& prescribed);

} // namespace springproof::fem_reference
