#include "msm/tangent.hpp"

#include <cassert>

namespace springproof::msm {

Tangent::Tangent(const Lattice& lattice, const std::vector<bool>& is_constrained)
    : lattice_(lattice), matrix_(is_constrained, [&](const auto& sink) {
        visit_tangent_blocks(lattice, lattice.rest, Clamp::yes, sink);
      }) {
  assert(is_constrained.size() == 3 * lattice.rest.size());
}

const Tangent::Matrix& Tangent::assemble(const Points& positions, Clamp clamp) {
  return matrix_.assemble([&](const auto& sink) { visit_tangent_blocks(lattice_, positions, clamp, sink); });
}

} // namespace springproof::msm
