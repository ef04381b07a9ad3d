// Surfaces as the confined process answers, which VTK's reader may have been taken over in, and the cells
// that they are filled with, and their distances as a tool's: a target for libFuzzer.

#include "cases/mesh/closed_surface.hpp"
#include "cases/mesh/voxels.hpp"
#include "cases/mesh/vtk_functions.hpp"
#include "mechanics/contact/surface_distance.hpp"
#include "tests/fuzz/promise.hpp"

#include <Eigen/Geometry>
#include <cstdint>

using namespace springproof;

namespace {

void check_distances(const cases::Surface& surface) {
  std::vector<std::string> remarks;
  const auto [vertices, triangles] = cases::rigid_surface(surface, 1, {"body.stl"}, remarks);
  const mechanics::SurfaceDistance distance({{}, 1, vertices, triangles});
  for (const auto& triangle : triangles) {
    const Eigen::Vector3d vertex = vertices[cases::index(triangle[0])], away(0.1, 0.2, 0.3);
    PROMISE(distance.at(vertex).value == 0);
    PROMISE(distance.at(vertex).normal.allFinite());
    PROMISE(distance.at(vertex + away).curvature.allFinite());
    PROMISE(std::abs(distance.at(vertex + away).value) <= 1.001 * away.norm());
  }
}

} // namespace

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
    check_distances(surface);
  } catch (const std::exception&) {
    // what wrong bytes are answered with
  }
  return 0;
}
