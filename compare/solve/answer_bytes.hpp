#pragma once

#include "cases/mesh/sharing.hpp"
#include "compare/solve/answers.hpp"

namespace springproof::compare {

/// Answers to a question on a mesh of which this is a share (share_of()), from bytes that anybody may have
/// made (cases::to_bytes() makes them).
/// @throws std::exception if they hold none: another length, an unknown enumerator, a converged solution
/// without a finite displacement for every node and a finite volume for every cell of the share, fields that
/// are not those of the share
Answers answers_from(const std::string& bytes, const cases::Share& share);

/// One model's, likewise.
Answer answer_from(const std::string& bytes, const cases::Share& share);

} // namespace springproof::compare
