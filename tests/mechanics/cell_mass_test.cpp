#include "mechanics/cell_mass.hpp"

#include <catch2/catch.hpp>

using namespace springproof;

namespace {

/// A parallelepiped of three edges, or a skew cell with one vertex moved.
mechanics::HexahedronVertices cell(double skew) {
  mechanics::HexahedronVertices vertices;
  for (int v = 0; v < 8; ++v)
    vertices[static_cast<std::size_t>(v)] = (v & 1) * Eigen::Vector3d(2, 0, 0) +
                                            ((v >> 1) & 1) * Eigen::Vector3d(0.5, 3, 0) +
                                            (v >> 2) * Eigen::Vector3d(0, 0.2, 4);
  vertices[7] += skew * Eigen::Vector3d(1, 1, 1);
  return vertices;
}

} // namespace

TEST_CASE("a cell that moves as a whole has its mass in every direction, and none across") {
  for (const double skew : {0., 0.3}) {
    const auto mass = mechanics::consistent_mass(cell(skew), 1.5);
    double volume = 0;
    for (int q = 0; q < 8; ++q)
      volume += mechanics::jacobian(cell(skew), mechanics::gauss_point(q)).determinant() / 8;
    Eigen::Matrix<double, 24, 3> whole;
    for (int v = 0; v < 8; ++v) whole.block<3, 3>(3 * v, 0).setIdentity();
    const Eigen::Matrix3d sums = whole.transpose() * mass * whole;
    CHECK((sums - 1.5 * volume * Eigen::Matrix3d::Identity()).norm() <= 1e-13 * volume);
    CHECK((mass - mass.transpose()).norm() <= 1e-14 * mass.norm());
  }
}

TEST_CASE("the mass of a parallelepiped is the product of three bars' masses") {
  const auto mass = mechanics::consistent_mass(cell(0), 1);
  const double volume = 2 * 3 * 4;
  for (int v = 0; v < 8; ++v)
    for (int w = 0; w < 8; ++w) {
      double expected = volume;
      for (int a = 0; a < 3; ++a) expected *= ((v ^ w) >> a) & 1 ? 1. / 6 : 1. / 3;
      CHECK(mass(3 * v, 3 * w) == Approx(expected).epsilon(1e-13));
      CHECK(mass(3 * v, 3 * w + 1) == 0);
    }
}
