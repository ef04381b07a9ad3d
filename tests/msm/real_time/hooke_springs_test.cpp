#include "msm/real_time/hooke_springs.hpp"

#include "mechanics/real_time/constraint.hpp"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>

using namespace springproof;
using Eigen::Vector3d;

namespace {

/// Six springs in two colours between eight points, the last two places of the second colour spare.
struct SixSprings {
  msm::WholePoints x, mobility;
  std::vector<msm::FourSprings> fours{2};

  explicit SixSprings(bool is_same_in_all_directions) {
    for (int p = 0; p < 10; ++p) {
      x.emplace_back(p, std::sin(p), std::cos(2. * p), 0);
      const double m = p < 8 ? 0.1 * (p % 5) : 0; // points 0 and 5 are held, which a spring joins
      mobility.emplace_back(m, is_same_in_all_directions ? m : p % 2 * m, m, 0);
    }
    for (int four = 0; four < 2; ++four)
      for (int s = 0; s < 4; ++s) {
        const bool is_spare = four == 1 && s > 1;
        msm::FourSprings& all = fours[std::size_t(four)];
        all.nodes[0][s] = is_spare ? 8 : s;
        all.nodes[1][s] = is_spare ? 9 : four == 0 ? 4 + (s + 1) % 4 : 2 + s;
        all.stiffness[s] = is_spare ? 0 : s == 2 ? -0.1 : 1 + s;
        all.rest_length[s] = is_spare ? 0 : 1.5;
        all.multiplier[s] = 7; // what another step has left
        for (int end = 0; end < 2; ++end) all.mobility[end][s] = mobility[std::size_t(all.nodes[end][s])][0];
      }
  }
};

} // namespace

TEST_CASE("four of Hooke's springs are projected at once as one after the other") {
  for (const bool is_same : {true, false}) {
    SixSprings springs(is_same);
    msm::WholePoints one_by_one = springs.x;
    std::vector<double> multipliers(8, 0);
    for (int iteration = 0; iteration < 3; ++iteration)
      for (std::size_t four = 0; four < 2; ++four) {
        msm::FourSprings& all = springs.fours[four];
        if (is_same)
          msm::project(&all, 1, iteration == 0, springs.x);
        else
          msm::project(&all, 1, iteration == 0, springs.x, springs.mobility);
        for (int s = 0; s < 4; ++s) {
          const std::array<std::size_t, 2> nodes{std::size_t(all.nodes[0][s]), std::size_t(all.nodes[1][s])};
          const Vector3d d = (one_by_one[nodes[1]] - one_by_one[nodes[0]]).head<3>();
          const std::array<Vector3d, 2> gradient{-d.normalized(), d.normalized()};
          mechanics::project(
              2, {all.stiffness[s] * (d.norm() - all.rest_length[s]), all.stiffness[s]},
              [&](std::size_t end) -> const Vector3d& { return gradient[end]; },
              [&](std::size_t end, const Vector3d& by) -> Vector3d {
                return springs.mobility[nodes[end]].head<3>().cwiseProduct(by);
              },
              multipliers[4 * four + std::size_t(s)],
              [&](std::size_t end, const Vector3d& by) { one_by_one[nodes[end]].head<3>() += by; });
        }
      }
    const SixSprings before(is_same);
    double moved = 0;
    for (std::size_t p = 0; p < one_by_one.size(); ++p) {
      CHECK((springs.x[p] - one_by_one[p]).norm() < 1e-14);
      moved = std::max(moved, (springs.x[p] - before.x[p]).norm());
    }
    CHECK(moved > 0.1);
    for (std::size_t n = 0; n < 6; ++n)
      CHECK(springs.fours[n / 4].multiplier[n % 4] == Approx(multipliers[n]).margin(1e-14));
  }
}
