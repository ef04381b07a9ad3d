#pragma once

#include "mechanics/petsc/handles.hpp"

namespace springproof::fem_reference {

using mechanics::petsc::check;
using mechanics::petsc::Matrix;
using mechanics::petsc::Vector;

} // namespace springproof::fem_reference
