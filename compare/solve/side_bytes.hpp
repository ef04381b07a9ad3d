#pragma once

#include "compare/solve/comparison.hpp"

#include <string>

namespace springproof::compare {

/// What solving found, both sides, the design, the mesh study and the peer, and what it chose (formulation
/// and refinement), as bytes for another process of this program on this machine. The rest of the scene and
/// what is measured on it are not in it.
std::string to_bytes(const Comparison& comparison);

/// Takes over what to_bytes() wrote, to the last bit.  @throws std::runtime_error if the bytes are not whole
void from_bytes(const std::string& bytes, Comparison& comparison);

} // namespace springproof::compare
