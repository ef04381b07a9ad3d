#include "compare/write/json.hpp"
#include "compare/write/write.hpp"

#include "cases/case/names.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

namespace springproof::compare {

using Json = nlohmann::ordered_json;

void write_text(std::ostream& out, const Peer& peer) {
  const cases::Solution& s = peer.answer.solution;
  fmt::print(out, "  peer {}: {}", peer.program, cases::name_of(s.status));
  if (s.status != cases::Status::converged) {
    fmt::print(out, ": {}\n", s.message);
    return;
  }
  fmt::print(out, ", {} unknowns, {} iterations, {:.3f} s", s.unknowns, s.newton_iterations,
             peer.answer.solve_seconds);
  if (peer.largest_difference)
    fmt::print(out, ", displacements within {:.1e} of fem's (of the largest)", *peer.largest_difference);
  fmt::print(out, "\n");
}

nlohmann::ordered_json to_json(const Peer& peer) {
  const cases::Solution& s = peer.answer.solution;
  return {{"program", peer.program},
          {"status", cases::name_of(s.status)},
          {"message", s.message},
          {"unknowns", s.unknowns},
          {"load_reached", s.load_reached},
          {"newton_iterations", s.newton_iterations},
          {"inverted_cells", s.inverted_cells},
          {"seconds", {{"solve", peer.answer.solve_seconds}}},
          {"largest_difference", peer.largest_difference}};
}

} // namespace springproof::compare
