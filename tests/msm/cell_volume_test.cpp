#include "msm/lattice.hpp"

#include "tests/support/bodies.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

using namespace springproof;

using Eigen::Vector3d;
using msm::CellPositions;

namespace {

CellPositions distorted_cell() {
  const msm::Points points =
      bodies::disturbed(cases::make_box_mesh({1, 1.2, 0.8}, {1, 1, 1}).nodes.to_vector(), 0.2);
  CellPositions x;
  std::copy(points.begin(), points.end(), x.begin());
  return x;
}

CellPositions moved(CellPositions x, int vertex, int axis, double by) {
  x[static_cast<std::size_t>(vertex)][axis] += by;
  return x;
}

constexpr double h = 1e-4; // mm; V is linear in one coordinate, so that only rounding, 1e-16/h, is left

} // namespace

TEST_CASE("the volume of a distorted cell is what quadrature gives") {
  const CellPositions x = distorted_cell();
  CHECK(msm::trilinear_volume(x) == Approx(cases::cell_volume(x)).epsilon(1e-14)); // rounding
}

TEST_CASE("the gradient of a cell's volume is its derivative") {
  const CellPositions x = distorted_cell();
  const auto gradient = msm::trilinear_volume_gradient(x);
  for (int v = 0; v < 8; ++v)
    for (int a = 0; a < 3; ++a) {
      const double difference =
          (msm::trilinear_volume(moved(x, v, a, h)) - msm::trilinear_volume(moved(x, v, a, -h))) / (2 * h);
      CHECK(gradient[static_cast<std::size_t>(v)][a] == Approx(difference).margin(1e-11)); // see h
    }
}

TEST_CASE("the second derivative of a cell's volume is its gradient's derivative") {
  const CellPositions x = distorted_cell();
  const auto second = msm::trilinear_volume_second_derivative(x);
  for (int b = 0; b < 8; ++b)
    for (int j = 0; j < 3; ++j) {
      const auto after = msm::trilinear_volume_gradient(moved(x, b, j, h)),
                 before = msm::trilinear_volume_gradient(moved(x, b, j, -h));
      for (std::size_t a = 0; a < 8; ++a) {
        const Vector3d difference = (after[a] - before[a]) / (2 * h);
        CHECK((second[a][static_cast<std::size_t>(b)].col(j) - difference).norm() < 1e-11); // see h
      }
    }
}
