#pragma once

#include "compare/solve/answers.hpp"

namespace springproof::compare {

/// Answers to a question on this mesh, from bytes that anybody may have made (cases::to_bytes() makes them).
/// @throws std::exception if they hold none: another length, an unknown enumerator, a converged solution
/// without a finite displacement for every node and a finite volume for every cell
Answers answers_from(const std::string& bytes, const cases::HexMesh& mesh);

/// One model's, likewise.
Answer answer_from(const std::string& bytes, const cases::HexMesh& mesh);

} // namespace springproof::compare
