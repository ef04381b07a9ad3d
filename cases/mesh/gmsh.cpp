#include "cases/mesh/gmsh.hpp"

#include "cases/case/installation.hpp"

namespace springproof::cases {

const GmshFunctions& gmsh() {
  static const auto* const functions =
      static_cast<const GmshFunctions*>(load_shared_object("springproof_gmsh"));
  return *functions;
}

} // namespace springproof::cases
