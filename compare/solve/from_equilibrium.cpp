#include "compare/solve/from_equilibrium.hpp"

#include "cases/case/error.hpp"
#include "mechanics/larger.hpp"

#include <cmath>
#include <fmt/format.h>
#include <new>
#include <utility>

namespace springproof::compare {

namespace {

/// Describes the distance in one sentence.
std::string describe_distance(const cases::Solution& solution, const std::string& of) {
  const cases::FromEquilibrium& from = *solution.from_equilibrium;
  const std::string rest =
      from.rest ? fmt::format("at rest after {:.3g} s, {} steps; ", from.rest->time, from.rest->steps) : "";
  const std::string state =
      rest + fmt::format("{} after {} iterations: residual {:.2e}, ",
                         solution.is_equilibrium() ? "in equilibrium" : "NOT IN EQUILIBRIUM",
                         solution.relaxation_iterations, solution.residual);
  if (!from.largest) return state + "the distance from equilibrium is not known: " + from.reason;
  return state +
         fmt::format("{:.3g} mm at most and {:.3g} mm in the root mean square from the equilibrium of {} "
                     "(Newton's method)",
                     *from.largest, *from.root_mean_square, of);
}

void set_distance(cases::Solution& solution, std::vector<Eigen::Vector3d> equilibrium) {
  double largest_squared = 0, sum = 0;
  for (std::size_t n = 0; n < solution.displacement.size(); ++n) {
    const double squared = (solution.displacement[n] - equilibrium[n]).squaredNorm();
    largest_squared = mechanics::larger(largest_squared, squared);
    sum += squared;
  }
  cases::FromEquilibrium& from = *solution.from_equilibrium;
  from.largest = std::sqrt(largest_squared);
  from.root_mean_square = std::sqrt(sum / static_cast<double>(solution.displacement.size()));
  from.displacement = std::move(equilibrium);
}

} // namespace

void add_distance(cases::Solution& solution, const std::string& of,
                  const std::function<std::vector<Eigen::Vector3d>()>& equilibrium) {
  try {
    set_distance(solution, equilibrium());
  } catch (const cases::SolveError& error) {
    solution.from_equilibrium->reason = error.what();
  } catch (const std::bad_alloc&) {
    solution.from_equilibrium->reason = "not enough memory";
  }
  solution.message = describe_distance(solution, of);
}

} // namespace springproof::compare
