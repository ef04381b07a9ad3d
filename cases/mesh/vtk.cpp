#include "cases/mesh/vtk.hpp"

#include "cases/case/installation.hpp"

namespace springproof::cases {

const VtkFunctions& vtk() {
  static const auto* const functions =
      static_cast<const VtkFunctions*>(load_shared_object("springproof_vtk"));
  return *functions;
}

} // namespace springproof::cases
