#include "msm/spring.hpp"

#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>

using namespace springproof;

using Eigen::Matrix3d;
using Eigen::Vector3d;
using msm::Spring;
using msm::TransverseTerm;

namespace {

const Spring spring{2.5, 1.3};
const Vector3d stretched(1.1, -0.7, 0.9);
const Vector3d compressed(0.6, 0.3, -0.5);
constexpr double h = 1e-6; // mm; the central difference then errs by about 1e-12 and its rounding by 1e-10

} // namespace

TEST_CASE("a stretched spring pulls its ends together and a compressed one pushes them apart") {
  CHECK(msm::spring_force(stretched, spring).dot(stretched) > 0);
  CHECK(msm::spring_force(compressed, spring).dot(compressed) < 0);
  // eq. 4.8 by hand: 2.5 (2 - 1.3)
  CHECK((msm::spring_force({0, 0, 2}, spring) - Vector3d(0, 0, 1.75)).norm() < 1e-15); // rounding
}

TEST_CASE("the force of a spring is the derivative of its energy") {
  for (const Vector3d& d : {stretched, compressed})
    for (int a = 0; a < 3; ++a) {
      const Vector3d step = h * Vector3d::Unit(a);
      const double difference =
          (msm::spring_energy(d + step, spring) - msm::spring_energy(d - step, spring)) / (2 * h);
      CHECK(msm::spring_force(d, spring)[a] == Approx(difference).margin(1e-9)); // see h
    }
}

TEST_CASE("the stiffness of a spring is the derivative of its force") {
  for (const Vector3d& d : {stretched, compressed}) {
    const Matrix3d stiffness = msm::spring_stiffness(d, spring, TransverseTerm::exact);
    for (int a = 0; a < 3; ++a) {
      const Vector3d step = h * Vector3d::Unit(a);
      const Vector3d difference =
          (msm::spring_force(d + step, spring) - msm::spring_force(d - step, spring)) / (2 * h);
      CHECK((stiffness.col(a) - difference).norm() < 1e-9); // see h
    }
  }
}

TEST_CASE(
    "clamping leaves a stretched spring as it is and takes a compressed one's transverse stiffness away") {
  CHECK(msm::spring_stiffness(stretched, spring, TransverseTerm::clamped) ==
        msm::spring_stiffness(stretched, spring, TransverseTerm::exact));
  const Matrix3d clamped = msm::spring_stiffness(compressed, spring, TransverseTerm::clamped);
  const Vector3d along = compressed.normalized();
  CHECK((clamped - spring.stiffness * along * along.transpose()).norm() < 1e-14); // rounding
  const Matrix3d exact = msm::spring_stiffness(compressed, spring, TransverseTerm::exact);
  const Eigen::SelfAdjointEigenSolver<Matrix3d> exact_modes(exact);
  CHECK(exact_modes.eigenvalues()[0] < 0); // which is why it must be clamped at all
}
