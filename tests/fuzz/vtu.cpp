// Points, their vectors and interpolation between them as the confined process answers, which VTK's reader
// may have been taken over in: a target for libFuzzer.

#include "cases/mesh/vtk_functions.hpp"
#include "tests/fuzz/displacements.hpp"

using namespace springproof;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const auto read = [](const std::string& text, const std::string& path) {
    return compare::displacements_in(cases::point_cloud_from(text), path);
  };
  fuzz::read_and_match(read, bytes, size);
  constexpr std::size_t n_nodes = 27;
  try {
    const cases::CellCloud cells =
        cases::cell_cloud_from({reinterpret_cast<const char*>(bytes), size}, n_nodes);
    const auto& displacements = compare::finite_displacements(cells.cloud, "given");
    PROMISE(cells.to_nodes.of(displacements).size() == n_nodes);
    PROMISE(cells.from_nodes.of(std::vector<Eigen::Vector3d>(n_nodes)).size() == cells.cloud.points.size());
  } catch (const std::exception&) {
    // what wrong input is answered with
  }
  return 0;
}
