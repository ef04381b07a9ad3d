#pragma once

#include "cases/scene/scene.hpp"
#include "fem_reference/grid/body.hpp"
#include "mechanics/dynamics/load_in_time.hpp"

#include <functional>
#include <vector>

namespace springproof::fem_reference::grid {

/// What acts on a body.
struct Supported {
  Field<double> load;                ///< N at full load; 0 on constrained entries
  std::vector<std::ptrdiff_t> moved; ///< entries of a field whose displacement is prescribed and not 0
  /// Their displacement (mm) at a load factor; empty when no rank has any. Collective.
  std::function<std::vector<double>(double load_factor)> prescribed;
  std::function<std::vector<double>(double time)> prescribed_at; ///< the same in a motion; s
};

/// The loads and motions of a scene on a rank's part of a grid.
/// @param scene         with the mesh of the elements
/// @param is_quadratic  elements have nodes on their edges and faces too: places are halves of them
/// @param body          that places is of; its `free` is set
Supported make_supported(const cases::Scene& scene, bool is_quadratic, const Places& places, Body& body);

/// @param scene, places  as of make_supported(), after it
/// The loads of a dynamic scene.
std::vector<mechanics::LoadInTime> loads_in_time(const cases::Scene& scene, bool is_quadratic,
                                                 const Places& places);

} // namespace springproof::fem_reference::grid
