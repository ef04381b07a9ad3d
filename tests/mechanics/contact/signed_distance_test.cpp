#include "mechanics/contact/signed_distance.hpp"

#include <catch2/catch.hpp>
#include <random>

using namespace springproof;

using cases::tools::Kind;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using mechanics::signed_distance;

namespace {

const Vector3d askew = Vector3d(1, 2, -2) / 3;

const Kind shapes[] = {cases::tools::Sphere{2}, cases::tools::Cylinder{2, askew},
                       cases::tools::Punch{2, askew}, cases::tools::Plane{askew}};

} // namespace

TEST_CASE("distances from tools are those of geometry") {
  CHECK(signed_distance(cases::tools::Sphere{2}, {0, 3, 4}).value == Approx(3));
  CHECK(signed_distance(cases::tools::Sphere{2}, {0, 1, 0}).value == Approx(-1));
  CHECK(signed_distance(cases::tools::Cylinder{2, Vector3d::UnitZ()}, {3, 4, 100}).value == Approx(3));
  CHECK(signed_distance(cases::tools::Plane{Vector3d::UnitY()}, {7, -0.5, 3}).value == Approx(-0.5));
  const cases::tools::Punch punch{2, -Vector3d::UnitZ()};
  CHECK(signed_distance(punch, {1, 0, -3}).value == Approx(3));           // before the flat end
  CHECK(signed_distance(punch, {1, 0, 0.5}).value == Approx(-0.5));       // behind it
  CHECK(signed_distance(punch, {1.75, 0, 0.5}).value == Approx(-0.25));   // nearer to the side
  CHECK(signed_distance(punch, {0, 5, 0.5}).value == Approx(3));          // beside it
  CHECK(signed_distance(punch, {5, 0, -4}).value == Approx(5));           // off the edge
  CHECK(signed_distance(punch, {2, 0, 0.5}).normal == Vector3d::UnitX()); // on the edge: beside
}

TEST_CASE("normals and curvatures are the derivatives of distances") {
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> any(-3, 3);
  constexpr double h = 1e-5; // central differences then err by about h² = 1e-10
  for (const Kind& shape : shapes)
    for (int n = 0; n < 40; ++n) {
      const Vector3d at(any(generator), any(generator), any(generator));
      const auto here = signed_distance(shape, at);
      CHECK(here.normal.norm() == Approx(1).epsilon(1e-12));
      Vector3d gradient;
      Matrix3d curvature;
      for (int c = 0; c < 3; ++c) {
        const auto ahead = signed_distance(shape, at + h * Vector3d::Unit(c)),
                   behind = signed_distance(shape, at - h * Vector3d::Unit(c));
        gradient[c] = (ahead.value - behind.value) / (2 * h);
        curvature.col(c) = (ahead.normal - behind.normal) / (2 * h);
      }
      INFO(cases::name_of(shape) << " at " << at.transpose());
      CHECK((gradient - here.normal).norm() < 1e-7);
      CHECK((curvature - here.curvature).norm() < 1e-7);
    }
}
