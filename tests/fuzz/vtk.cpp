#include "cases/mesh/vtk_functions.hpp"

namespace springproof::cases {

extern "C" const VtkFunctions springproof_vtk;

const VtkFunctions& vtk() {
  return springproof_vtk;
}

} // namespace springproof::cases
