#include "compare/peers/calculix.hpp"
#include "compare/solve/solve_side.hpp"

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

Peer ask_calculix(const cases::Scene& scene, const cases::Solution& fem) {
  Peer peer{"CalculiX", {}, std::nullopt};
  Stopwatch stopwatch;
  try {
    peer.answer.solution = solve_with_calculix(scene);
  } catch (const cases::SolveError& error) {
    peer.answer.solution = failed_solution(error);
  }
  peer.answer.solve_seconds = stopwatch.lap();
  if (peer.answer.solution.status == cases::Status::converged && fem.status == cases::Status::converged)
    peer.largest_difference = largest_difference(fem, peer.answer.solution);
  return peer;
}

} // namespace springproof::compare
