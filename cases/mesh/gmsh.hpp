#pragma once

#include "cases/mesh/gmsh_functions.hpp"

namespace springproof::cases {

/// gmsh and the ninety libraries it needs, loaded when first called: a tenth of a second.
const GmshFunctions& gmsh();

} // namespace springproof::cases
