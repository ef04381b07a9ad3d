#pragma once

#include "cases/mesh/vtk_functions.hpp"

namespace springproof::cases {

/// For commands that need VTK after they have solved.
/// @throws InputError where the program was built without VTK, with what to type
void check_has_vtk();

/// Loads the shared object springproof_vtk at the first call. Linked to the programs, VTK's libraries would
/// lengthen every start by a fifth.
/// @throws InputError as check_has_vtk()
const VtkFunctions& vtk();

} // namespace springproof::cases
