#pragma once

#include "cases/scene/scene.hpp"

namespace springproof::cases {

/// Nodes of a network that nothing holds in place, which make it a mechanism: those without springs, and
/// pieces of nodes and springs that hang on nothing, each with the numbers of its first nodes. Supports hold
/// the nodes that they act on.
std::vector<std::string> loose_parts_of(const Scene& scene);

/// Reads the springs of a scene's network, if it has one. For one without cells it makes the masses and the
/// finite elements' scene too.
/// @param as_read  the case, whose nearest nodes are other ones on the finite elements' mesh
/// @throws InputError, also when a spring without a rest length of its own joins nodes in one place, and when
/// something needs masses and there are none
void resolve_network(Scene& scene, const Case& as_read);

} // namespace springproof::cases
