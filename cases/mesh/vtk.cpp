#include "cases/mesh/vtk_functions.hpp"

#include "cases/case/error.hpp"
#include "cases/case/installation.hpp"

#include <filesystem>
#include <system_error>

namespace springproof::cases {

void check_has_vtk() {
  std::error_code none;
  if (!std::filesystem::exists(private_file("springproof_vtk.so"), none))
    throw InputError(
        "this build has no VTK (.vtu, .vtp and .stl files, pictures, surfaces in meshes): type ./do "
        "packages, then ./do build");
}

const VtkFunctions& vtk() {
  static const auto* const functions = [] {
    check_has_vtk();
    return static_cast<const VtkFunctions*>(load_shared_object("springproof_vtk"));
  }();
  return *functions;
}

} // namespace springproof::cases
