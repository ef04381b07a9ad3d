// Surfaces that a body takes along as the confined process answers, which VTK's reader may have been taken
// over in, joined and bound to cells: a target for libFuzzer.

#include "cases/mesh/vtk_functions.hpp"
#include "mechanics/surface/embedded_surface.hpp"
#include "tests/fuzz/promise.hpp"

#include <cmath>
#include <cstdint>

using namespace springproof;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  static const cases::Mesh mesh = cases::make_box_mesh({2, 2, 2}, {2, 2, 2});
  try {
    cases::TriangleMesh surface =
        cases::joined(cases::surface_from({reinterpret_cast<const char*>(bytes), size}));
    for (const auto& triangle : surface.triangles)
      for (std::size_t c = 0; c < 3; ++c) {
        PROMISE(triangle[c] >= 0 && cases::index(triangle[c]) < surface.vertices.size());
        PROMISE(triangle[c] != triangle[(c + 1) % 3]);
      }
    const std::size_t n_vertices = surface.vertices.size();
    const mechanics::EmbeddedSurface embedded = mechanics::embed(std::move(surface), mesh);
    PROMISE(embedded.vertices.size() == n_vertices && embedded.n_outside <= n_vertices);
    for (const mechanics::EmbeddedPoint& vertex : embedded.vertices)
      for (std::size_t v = 0; v < 8; ++v) {
        PROMISE(vertex.nodes[v] >= 0 && cases::index(vertex.nodes[v]) < mesh.nodes.size());
        PROMISE(std::isfinite(vertex.weights[v]));
      }
  } catch (const std::exception&) {
    // what wrong bytes are answered with
  }
  return 0;
}
