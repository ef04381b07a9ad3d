#include "msm/grid/real_time_solver.hpp"

#include "tests/msm/moving_bodies.hpp"

#include <catch2/catch.hpp>

using namespace springproof;

namespace moving_bodies {

TEST_CASE("in real time a step's equation is solved in single precision: holes, damping, pulls, midlines, "
          "any units",
          "[verification]") {
  const cases::MaterialDynamics damped{1000., 3, 0.02}, undamped{1000., 3, 0};
  for (const bool has_holes : {false, true})
    for (const auto& material : {undamped, damped})
      for (const double unit : {1., 1e-25, 1e25}) // factor on every stiffness
        for (const double stiffness : {0., 0.01, 100., 1e4, 1e6}) {
          CAPTURE(has_holes, material.stiffness_damping, unit, stiffness);
          cases::Scene scene = block({}, material, has_holes, 15); // too many unknowns for a factor
          if (stiffness == 100 || stiffness == 0) scene = with_consistent_masses(std::move(scene));
          msm::CellStiffness springs = hybrid_springs;
          if (unit != 1) springs.midline = 0.5;
          const Moving body(scene, {msm::scaled(springs, unit)});
          // The mass term is as large as the stiffness, whatever its unit.
          const Vector rest = body.rest();
          const mechanics::StepTerms terms{1e5 * unit, 20, rest, rest, rest, 1};
          const Vector at = body.random_motion(0.2, 1), right_side = unit * body.random_motion(1, 2);
          if (stiffness > 0) {
            const auto entry = [&](Eigen::Index e, double weight) {
              return msm::Pull::Entry{e, weight, true};
            };
            const Eigen::Index n = body.vectors.size() / 3, node = n - 5;
            msm::Pull::Entries entries;
            for (int c = 0; c < 3; ++c)
              entries[cases::index(c)] = {entry(node + c * n, 0.7), entry(node + c * n - 9, 0.3)};
            body.motion->hold(msm::Pull(entries, unit * stiffness));
          }
          body.motion->set_step(terms);
          const auto exact = body.motion->direction(at, right_side, 0, 1e-10, mechanics::Convexity::exact);
          REQUIRE(exact);
          mechanics::StepTerms in_real_time = terms;
          in_real_time.enough_linear_iterations = 60;
          body.motion->set_step(in_real_time);
          const auto found = body.motion->direction(at, right_side, 0, 1e-5, mechanics::Convexity::exact);
          REQUIRE(found);
          // The residual is left at 1e-5; the smallest eigenvalues, a hundredth of the others, enlarge that.
          CHECK((*found - *exact).norm() <= 1e-3 * exact->norm());
          CHECK((*found - *exact).norm() > 1e-9 * exact->norm()); // it is not the solver in double precision
        }
}

} // namespace moving_bodies
