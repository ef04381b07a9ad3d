#pragma once

#include "msm/grid/body.hpp"

namespace springproof::msm::grid {

/// Whether a body at rest resists every motion for a reason that counting shows: the 28 springs of a cell
/// hold all distances between its vertices, cells that share a face share points that are not on a line and
/// move as one, and each piece that hangs together by faces is held at three such points at least. It is not
/// the only reason why a body may: false says nothing. Stiffnesses of less than a thousandth of the largest,
/// or negative ones, do not count, and of a part of a body nothing is known.
bool is_rigid_by_faces(const Body& body);

} // namespace springproof::msm::grid
