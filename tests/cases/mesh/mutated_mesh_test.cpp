#include "cases/mesh/fill_surface.hpp"
#include "cases/mesh/read_mesh.hpp"
#include "tests/fuzz/mutate.hpp"
#include "tests/support/temporary_folder.hpp"

#include <catch2/catch.hpp>
#include <cstdlib>
#include <functional>
#include <map>

// Damaged files of meshes and surfaces end in one line, or in a body whose cells are sound.
// tests/faults/mutated_files.py gives such files to the program.

using namespace springproof;

using namespace cases;

namespace {

/// Files of a kind: 500, or what SPRINGPROOF_DAMAGED_FILES says. Under sanitizers a file takes some ten times
/// as long.
int n_files() {
  const char* const asked = std::getenv("SPRINGPROOF_DAMAGED_FILES");
  return asked ? std::stoi(asked) : 500;
}

/// A tetrahedron about the origin's corner.
const std::map<std::string, std::string> surfaces{
    {"a.obj", "# a tetrahedron\nv 0 0 0\nv 2 0 0\nv 0 2 0\nv 0 0 2\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"},
    {"a.ply",
     "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
     "element face 4\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n2 0 0\n0 2 0\n0 0 2\n"
     "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n"}};

/// Reads damaged files, the same ones in every run.  @return number of those that were read
int read_mutated(const std::string& name, const std::string& whole,
                 const std::function<Mesh(const NamedFile&)>& read) {
  const TemporaryFolder folder;
  fuzz::Random random(20261127);
  int n_read = 0;
  for (int n = 0, end = n_files(); n < end; ++n) {
    const std::string path = folder.write(name, fuzz::mutated(whole, random));
    try {
      const Mesh mesh = read({path, {}});
      ++n_read;
      REQUIRE(!mesh.cells.empty());
      for (std::size_t c = 0; c < mesh.cells.size(); ++c)
        REQUIRE(smallest_corner_jacobian(cell_corners(mesh, c)) > 0);
    } catch (const InputError& error) {
      CAPTURE(n, error.what());
      CHECK(std::string(error.what()).find('\n') == std::string::npos);
      CHECK(std::string(error.what()).find(name) != std::string::npos);
    }
  }
  return n_read;
}

} // namespace

TEST_CASE("damaged meshes of each format are read or refused in one line", "[long]") {
  const std::string files = std::string(SPRINGPROOF_SOURCE_DIR) + "/tests/cases/mesh/files/";
  for (const std::string name :
       {"gmsh_22_text.msh", "gmsh_22_binary.msh", "gmsh_41_text.msh", "gmsh_41_binary.msh", "meshio.vtu",
        "meshio.vtk", "vtk.vtu", "gmsh_text.vtk"}) {
    CAPTURE(name);
    const int n =
        read_mutated(name, content(files + name), [](const NamedFile& file) { return read_mesh({file}); });
    CHECK(n < n_files());
  }
}

TEST_CASE("damaged surfaces of each format are filled or refused in one line", "[long]") {
  for (const auto& [name, whole] : surfaces) {
    CAPTURE(name);
    const int n = read_mutated(name, whole, [](const NamedFile& file) {
      std::vector<std::string> remarks;
      return fill_surface({file, 1}, remarks);
    });
    CHECK(n < n_files());
  }
}
