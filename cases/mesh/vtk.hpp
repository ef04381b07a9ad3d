#pragma once

#include "cases/mesh/vtk_functions.hpp"

namespace springproof::cases {

/// Loads the shared object springproof_vtk at the first call. Linked to the programs, VTK's libraries would
/// lengthen every start by a fifth.
const VtkFunctions& vtk();

} // namespace springproof::cases
