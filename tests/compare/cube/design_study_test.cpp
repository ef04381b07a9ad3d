#include "compare/cube/design_study.hpp"

#include <catch2/catch.hpp>

using namespace springproof;

namespace {

compare::DesignAttempt measured(double error_percent, double compression) {
  compare::DesignAttempt attempt;
  attempt.stability = msm::StabilityRange{3, compression, 2};
  attempt.cube.emplace();
  attempt.cube->small.worst = error_percent;
  attempt.cube->large.worst = error_percent / 2;
  return attempt;
}

} // namespace

TEST_CASE("a design that another beats in accuracy and stability is not on the Pareto front") {
  const std::vector<compare::DesignAttempt> attempts = {measured(5, 0.7), measured(8, 0.6), measured(6, 0.8)};
  const std::vector<bool> front = compare::on_pareto_front(attempts);
  CHECK(front == std::vector<bool>{true, true, false});
}

TEST_CASE("a design that failed a test or was not measured is on no front") {
  compare::DesignAttempt failed = measured(1, 0.3);
  failed.cube->large.worst.reset();
  CHECK_FALSE(failed.cube->worst());
  const compare::DesignAttempt unmeasured;
  CHECK(compare::on_pareto_front({failed, measured(5, 0.7), unmeasured}) ==
        std::vector<bool>{false, true, false});
}

TEST_CASE("the stable strain is the smaller of the two directions'") {
  CHECK(compare::stable_strain({std::exp(0.5), std::exp(-0.2), 1}) ==
        Approx(0.2).epsilon(1e-14)); // exp and log
  CHECK(compare::stable_strain({std::exp(0.1), std::exp(-0.2), 1}) == Approx(0.1).epsilon(1e-14));
}
