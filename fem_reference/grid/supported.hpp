#pragma once

#include "cases/scene/scene.hpp"
#include "fem_reference/grid/body.hpp"
#include "mechanics/dynamics/dynamic_problem.hpp"

#include <functional>
#include <vector>

namespace springproof::fem_reference::grid {

/// Loads and supports of a body.
struct Supported {
  Field<double> load;                ///< N at full load; 0 on constrained entries
  std::vector<std::ptrdiff_t> moved; ///< entries of a field whose displacement is prescribed and not 0
  /// Their displacement (mm) at a load factor; empty when no rank has any. Collective.
  std::function<std::vector<double>(double load_factor)> prescribed;
  std::function<std::vector<double>(double time)> prescribed_at; ///< the same in a motion; s
};

/// The loads and motions of a scene on a rank's part of a grid.
/// @param scene         the scene on the elements' mesh
/// @param is_quadratic  elements have nodes on their edges and faces too: places are halves of them
/// @param body          the body of `places`; its `free` is set
Supported make_supported(const cases::Scene& scene, bool is_quadratic, const Places& places, Body& body);

/// Loads of a dynamic scene. Call it after make_supported().
/// @param scene, places  as in make_supported()
std::vector<mechanics::LoadInTime> loads_in_time(const cases::Scene& scene, bool is_quadratic,
                                                 const Places& places);

} // namespace springproof::fem_reference::grid
