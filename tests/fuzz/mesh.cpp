// What the confined process answers about a mesh or a filled surface, as a target for libFuzzer: gmsh or VTK
// read a stranger's file there, and may have been taken over by it. gmsh itself, which cannot be built with
// the sanitizers here, may crash: that is what it is confined for, and what tests/faults/mutated_files.py
// tries.

#include "cases/mesh/read_mesh.hpp"
#include "tests/fuzz/promise.hpp"

#include <cstdint>

using namespace springproof;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  try {
    const cases::Mesh mesh = cases::mesh_from({reinterpret_cast<const char*>(bytes), size});
    PROMISE(!mesh.cells.empty());
    for (const Eigen::Vector3d& node : mesh.nodes) PROMISE(node.allFinite());
    PROMISE(mesh.group_of_cell.empty() || mesh.group_of_cell.size() == mesh.cells.size());
    PROMISE(cases::inverted_cells(mesh, {}).size() == mesh.cells.size());
    PROMISE(cases::boundary_faces(mesh).size() <= 6 * mesh.cells.size());
    PROMISE(cases::refine(mesh).cells.size() == 8 * mesh.cells.size());
  } catch (const std::exception&) {
    // what wrong bytes are answered with
  }
  return 0;
}
