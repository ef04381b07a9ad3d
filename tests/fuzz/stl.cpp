// Surfaces as the confined process answers, which VTK's reader may have been taken over in, and the cells
// that they are filled with: a target for libFuzzer.

#include "cases/mesh/voxels.hpp"
#include "cases/mesh/vtk_functions.hpp"
#include "tests/fuzz/promise.hpp"

#include <Eigen/Geometry>
#include <cstdint>

using namespace springproof;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  try {
    const cases::Surface surface = cases::surface_from({reinterpret_cast<const char*>(bytes), size});
    Eigen::AlignedBox3d body;
    for (const auto& triangle : surface)
      for (const Eigen::Vector3d& vertex : triangle) {
        PROMISE(vertex.allFinite());
        body.extend(vertex);
      }
    const double edge = body.sizes().maxCoeff() / 8;
    if (!(edge > 0) || !std::isfinite(edge)) return 0; // no case file has such an edge
    const cases::Mesh mesh = cases::make_voxel_mesh(surface, {{"body.stl"}, edge});
    PROMISE(!mesh.cells.empty() && mesh.grid);
  } catch (const std::exception&) {
    // what wrong bytes are answered with
  }
  return 0;
}
