#include "cases/mesh/vtk.hpp"

namespace springproof::cases {

extern "C" const VtkFunctions springproof_vtk;

const VtkFunctions& vtk() {
  return springproof_vtk;
}

} // namespace springproof::cases
