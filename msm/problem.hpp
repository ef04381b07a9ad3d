#pragma once

#include "cases/hex_mesh.hpp"
#include "msm/lattice.hpp"

#include <functional>
#include <vector>

namespace msm {

/// A lattice that is held and loaded.
struct Problem {
  cases::HexMesh mesh;
  Lattice lattice;
  Points force;               ///< applied at full load, N, one per point
  std::vector<bool> is_fixed; ///< degree of freedom 3*point + component is no unknown
  /// Displacement (mm) of the held points at a load factor, one per point; empty: they stay at rest.
  std::function<Points(double load_factor)> supports{};
};

} // namespace msm
