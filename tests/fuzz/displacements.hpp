#pragma once

#include "compare/peers/external_side.hpp"
#include "tests/fuzz/promise.hpp"

#include <cstdint>
#include <stdexcept>

namespace fuzz {

/// Displacements of any bytes, matched with the nodes of a box of 2 x 2 x 2 mm in 2 x 2 x 2 cells.
template<class Read>
void read_and_match(const Read& read, const std::uint8_t* bytes, std::size_t size) {
  using namespace springproof;
  static const cases::Mesh mesh = cases::make_box_mesh({2, 2, 2}, {2, 2, 2});
  try {
    const auto given = read({reinterpret_cast<const char*>(bytes), size}, "given");
    for (const compare::GivenDisplacement& node : given)
      PROMISE(node.position.allFinite() && node.displacement.allFinite());
    PROMISE(compare::match_nodes(mesh, given, "given").size() == mesh.nodes.size());
  } catch (const std::runtime_error&) {
    // what wrong input is answered with
  }
}

} // namespace fuzz
