// Grids of classes as the confined process answers, which VTK's readers may have been taken over in: a target
// for libFuzzer.

#include "cases/mesh/labels.hpp"
#include "tests/fuzz/promise.hpp"

#include <cstdint>

using namespace springproof;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const std::string content(reinterpret_cast<const char*>(bytes), size);
  cases::Labels labels;
  labels.edge = 1;
  labels.classes = {{"bone", 100, 200, true}, {"skin", 0, 99, false}};
  labels.keep = cases::Keep::largest;
  try {
    cases::LabelGrid grid = cases::label_grid_from(content, labels.classes.size());
    cases::keep_piece(grid, labels);
    const cases::Mesh mesh = cases::mesh_of(grid, labels);
    PROMISE(!mesh.cells.empty() && mesh.grid && mesh.group_of_cell.size() == mesh.cells.size());
  } catch (const std::exception&) {
    // what wrong bytes are answered with
  }
  return 0;
}
