#include "compare/peers/calculix.hpp"
#include "compare/solve/comparison.hpp"

#include <chrono>

namespace springproof::compare {

namespace {

/// Largest difference of two displacements over the largest displacement of the first; NaN if a number is.
double largest_difference(const cases::Solution& a, const cases::Solution& b) {
  using Field = Eigen::Map<const Eigen::Matrix3Xd>;
  const Field u(a.displacement[0].data(), 3, Eigen::Index(a.displacement.size()));
  const Field v(b.displacement[0].data(), 3, Eigen::Index(b.displacement.size()));
  const auto largest = [](const auto& field) {
    return field.colwise().norm().template maxCoeff<Eigen::PropagateNaN>();
  };
  return largest(u - v) / largest(u);
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
