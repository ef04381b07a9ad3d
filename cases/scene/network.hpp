#pragma once

#include "cases/scene/scene.hpp"

namespace springproof::cases {

/// Nodes of a network that nothing holds in place, which make it a mechanism: those without springs, and
/// pieces of nodes and springs that hang on nothing, each with the numbers of its first nodes. Supports hold
/// the nodes that they act on.
std::vector<std::string> loose_parts_of(const Scene& scene);

} // namespace springproof::cases
