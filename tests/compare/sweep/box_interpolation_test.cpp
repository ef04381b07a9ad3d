#include "compare/sweep/reference.hpp"

#include "cases/mesh/hex_mesh.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

using namespace springproof;

using Eigen::Vector3d;

namespace {

std::vector<Vector3d> sampled(const std::array<int, 3>& cells,
                              const std::function<Vector3d(const Vector3d&)>& field) {
  std::vector<Vector3d> values;
  for (const Vector3d& node : cases::make_box_mesh({2, 3, 5}, cells).nodes) values.push_back(field(node));
  return values;
}

Vector3d trilinear(const Vector3d& x) {
  return {1 + x.x() * x.y() * x.z(), x.x() - 2 * x.y() * x.z(), 3 - x.z()};
}

} // namespace

TEST_CASE("a trilinear field is carried to any other grid of the box, nested or not", "[verification]") {
  for (const std::array<int, 3> from : {std::array<int, 3>{1, 1, 1}, {2, 3, 4}, {5, 1, 2}})
    for (const std::array<int, 3> to : {std::array<int, 3>{1, 1, 1}, {3, 2, 7}, {4, 6, 8}}) {
      const auto values = compare::interpolate(sampled(from, trilinear), from, to);
      const auto exact = sampled(to, trilinear);
      REQUIRE(values.size() == exact.size());
      for (std::size_t n = 0; n < exact.size(); ++n)
        CHECK((values[n] - exact[n]).norm() <= 1e-13); // rounding of values up to 30
    }
}

TEST_CASE("nodes that two grids share keep their values to the last bit") {
  const auto rough = [](const Vector3d& x) {
    return Vector3d(std::sin(9 * x.x()), std::exp(x.y()), 1 / (1 + x.z()));
  };
  const auto coarse = sampled({3, 3, 3}, rough);
  CHECK(compare::interpolate(compare::interpolate(coarse, {3, 3, 3}, {6, 12, 3}), {6, 12, 3}, {3, 3, 3}) ==
        coarse);
}
