// Points and their vectors as the confined process answers, which VTK's reader may have been taken over in: a
// target for libFuzzer.

#include "cases/mesh/read_vtk.hpp"
#include "tests/fuzz/displacements.hpp"

using namespace springproof;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const auto read = [](const std::string& text, const std::string& path) {
    return compare::displacements_in(cases::point_cloud_from(text), path);
  };
  fuzz::read_and_match(read, bytes, size);
  return 0;
}
