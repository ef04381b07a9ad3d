#include "compare/solve/side_bytes.hpp"

#include "compare/solve/fields.hpp"

namespace cereal {

SPRINGPROOF_FIELDS(springproof::compare::Answer, solution, setup_seconds, solve_seconds)
SPRINGPROOF_FIELDS(springproof::compare::RefinedMeshes, refine, solutions, reason)
SPRINGPROOF_FIELDS(springproof::compare::Peer, program, answer, largest_difference)
SPRINGPROOF_FIELDS(springproof::compare::Answers, resolved, choices, fem, msm, msm_source, design, refined,
                   peer)

} // namespace cereal

namespace springproof::compare {

std::string to_bytes(const Answers& answers) {
  return to_bytes<cereal::PortableBinaryOutputArchive>(answers);
}

Answers from_bytes(const std::string& bytes) {
  Answers answers;
  from_bytes(bytes, answers);
  return answers;
}

} // namespace springproof::compare
