#pragma once

#include "mechanics/petsc/handles.hpp"

namespace springproof::fem_reference {

using mechanics::petsc::check;
using mechanics::petsc::Matrix;
using mechanics::petsc::ReadEntries;
using mechanics::petsc::Vector;
using mechanics::petsc::WriteEntries;

} // namespace springproof::fem_reference
