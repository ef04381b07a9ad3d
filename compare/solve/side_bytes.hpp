#pragma once

#include "compare/solve/answers.hpp"

#include <string>

namespace springproof::compare {

/// All answers to a case as bytes for another process of this program on this machine.
std::string to_bytes(const Answers& answers);

/// Takes over what to_bytes() wrote, to the last bit.  @throws std::runtime_error if the bytes are not whole
Answers from_bytes(const std::string& bytes);

} // namespace springproof::compare
