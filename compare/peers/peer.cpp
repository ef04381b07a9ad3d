#include "compare/peers/calculix.hpp"
#include "compare/solve/comparison.hpp"

#include <algorithm>
#include <chrono>

namespace springproof::compare {

namespace {

double largest_difference(const cases::Solution& a, const cases::Solution& b) {
  double difference = 0, size = 0;
  for (std::size_t n = 0; n < a.displacement.size(); ++n) {
    difference = std::max(difference, (a.displacement[n] - b.displacement[n]).norm());
    size = std::max(size, a.displacement[n].norm());
  }
  return difference / size;
}

} // namespace

void ask_calculix(Comparison& comparison) {
  Peer peer{"CalculiX", {}, std::nullopt};
  const auto start = std::chrono::steady_clock::now();
  try {
    peer.side.solution = solve_with_calculix(comparison.scene);
  } catch (const cases::SolveError& error) {
    peer.side.solution.status = cases::Status::failed;
    peer.side.solution.message = error.what();
    peer.side.solution.load_reached = error.load_reached();
  }
  peer.side.solve_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();

  if (peer.side.solution.status == cases::Status::converged &&
      comparison.fem.solution.status == cases::Status::converged)
    peer.largest_difference = largest_difference(comparison.fem.solution, peer.side.solution);
  comparison.peer = peer;
  measure_sides(comparison);
}

} // namespace springproof::compare
