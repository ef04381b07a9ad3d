#include "msm/spring.hpp"

#include "mechanics/dense.hpp"

#include <catch2/catch.hpp>

using namespace springproof;

using Eigen::Matrix3d;
using Eigen::Vector3d;
using msm::Clamp;
using msm::Spring;
using msm::SpringLaw;

namespace {

const Spring spring{2.5, 1.3};
SpringLaw power_log(double exponent) {
  return {msm::LawKind::power_log, exponent};
}
const Spring springs[] = {spring,
                          {2.5, 1.3, power_log(-1.5)},
                          {2.5, 1.3, power_log(-1)},
                          {2.5, 1.3, power_log(-1 + 1e-5)},
                          {2.5, 1.3, power_log(1.788)}};
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
  for (const Spring& of : springs)
    for (const Vector3d& d : {stretched, compressed})
      for (int a = 0; a < 3; ++a) {
        const Vector3d step = h * Vector3d::Unit(a);
        const double difference =
            (msm::spring_energy(d + step, of) - msm::spring_energy(d - step, of)) / (2 * h);
        CHECK(msm::spring_force(d, of)[a] == Approx(difference).margin(1e-9)); // see h
      }
}

TEST_CASE("the stiffness of a spring is the derivative of its force") {
  for (const Spring& of : springs)
    for (const Vector3d& d : {stretched, compressed}) {
      const Matrix3d stiffness = msm::spring_stiffness(d, of, Clamp::no);
      for (int a = 0; a < 3; ++a) {
        const Vector3d step = h * Vector3d::Unit(a);
        const Vector3d difference =
            (msm::spring_force(d + step, of) - msm::spring_force(d - step, of)) / (2 * h);
        CHECK((stiffness.col(a) - difference).norm() < 1e-9); // see h
      }
    }
}

TEST_CASE("a power-log spring has the stiffness of Hooke's at rest, and the curvature of its exponent") {
  for (const double p : {-1.5, -1., 0., 4.273}) {
    const Spring of{2.5, 1.3, power_log(p)};
    const auto [along, transverse] = msm::spring_slopes(1.3, of);
    CHECK(along == Approx(2.5).epsilon(1e-14));
    CHECK(transverse == 0);
    const double step = 1e-4, curvature = (msm::spring_slopes(1.3 + step, of).along -
                                           msm::spring_slopes(1.3 - step, of).along) /
                                          (2 * step);
    CHECK(curvature == Approx((2 * p - 1) * 2.5 / 1.3).epsilon(1e-6)); // the difference errs by step²
  }
}

TEST_CASE("the energy of a power-log spring is one function of its exponent") {
  const double q = 1.7, log = std::log(q);
  const auto energy = [&](double p) { return msm::spring_energy({0, 0, q}, {1, 1, power_log(p)}); };
  for (const double s : {-2.5, -0.5, 0.5, 3.}) // where the closed form has its digits
    CHECK(energy(s - 1) == Approx((std::pow(q, s) * (s * log - 1) + 1) / (s * s)).epsilon(1e-13));
  CHECK(energy(-1) == Approx(log * log / 2).epsilon(1e-15));
  for (const double s : {1 / log, -1 / log}) // series and closed form meet
    CHECK(energy(s * (1 - 1e-12) - 1) == Approx(energy(s * (1 + 1e-12) - 1)).epsilon(1e-11));
}

TEST_CASE("the energy of a power-log spring next to rest keeps its digits") {
  const Spring of{2.5, 1.3, power_log(1.788)};
  for (const double strain : {1e-9, -1e-7, 1e-5}) {
    const double d = 1.3 * strain,
                 curved = (2 * 1.788 - 1) / 3 * strain; // k d²/2 (1 + (2p - 1) strain/3 + ...)
    // the length has 1e-16 of itself
    CHECK(msm::spring_energy({0, 0, 1.3 + d}, of) ==
          Approx(1.25 * d * d * (1 + curved)).epsilon(4e-16 / std::abs(strain) + strain * strain * 10));
  }
}

TEST_CASE("the clamped stiffness of a spring that has passed its largest tension is not negative") {
  const Spring of{2.5, 1.3, power_log(-2)}; // its largest tension is at ln q = 1/2
  const Vector3d far(0, 0, 3);
  CHECK(msm::spring_slopes(3, of).along < 0);
  CHECK(mechanics::eigenvalues(msm::spring_stiffness(far, of, Clamp::yes))[0] >= 0);
}

TEST_CASE(
    "clamping leaves a stretched spring as it is and takes a compressed one's transverse stiffness away") {
  CHECK(msm::spring_stiffness(stretched, spring, Clamp::yes) ==
        msm::spring_stiffness(stretched, spring, Clamp::no));
  const Matrix3d clamped = msm::spring_stiffness(compressed, spring, Clamp::yes);
  const Vector3d along = compressed.normalized();
  CHECK((clamped - spring.stiffness * along * along.transpose()).norm() < 1e-14); // rounding
  const Matrix3d exact = msm::spring_stiffness(compressed, spring, Clamp::no);
  CHECK(mechanics::eigenvalues(exact)[0] < 0); // which is why it must be clamped at all
}
