#include "cases/mesh/vtk.hpp"

#include <dlfcn.h>
#include <stdexcept>

namespace springproof::cases {

const VtkFunctions& vtk() {
  static const VtkFunctions& functions = []() -> const VtkFunctions& {
    void* const library = dlopen(SPRINGPROOF_VTK, RTLD_NOW | RTLD_LOCAL);
    const void* const symbol = library ? dlsym(library, "springproof_vtk") : nullptr;
    if (!symbol) throw std::runtime_error(dlerror());
    return *static_cast<const VtkFunctions*>(symbol);
  }();
  return functions;
}

} // namespace springproof::cases
