#pragma once

#include "msm/grid/body.hpp"

namespace springproof::compare {

/// A cube of cells of 1 mm with the linear method's springs of E = 0.3 MPa and nu = 0.35, its lowest plane
/// held: what the kernels are timed on.
inline msm::grid::Body timed_cube(int cells) {
  msm::grid::Body body;
  body.cells = {cells, cells, cells};
  body.spacing = {1, 1, 1};
  body.springs = {{{0.031, 0.031, 0.031}, {0.047, 0.047, 0.047}, 0.033, 0}};
  set_layout(body, [](int, int, int k, int) { return k == 0; });
  return body;
}

} // namespace springproof::compare
