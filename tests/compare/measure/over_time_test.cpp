#include "compare/measure/over_time.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace springproof;

using cases::OverTime;
using compare::TimeSeries;

namespace {

const double tau = 2 * std::acos(-1.0);

/// settled (1 - exp(-zeta omega t) cos(omega_d t)), 100 values a second for 2 s, as motion capture has.
TimeSeries released(double settled, double zeta, double damped_frequency) {
  TimeSeries series;
  const double omega = tau * damped_frequency / std::sqrt(1 - zeta * zeta);
  for (int i = 0; i <= 200; ++i) {
    const double t = 0.01 * i;
    series.time.push_back(t);
    series.value.push_back(settled *
                           (1 - std::exp(-zeta * omega * t) * std::cos(tau * damped_frequency * t)));
  }
  return series;
}

TimeSeries constant(double value) {
  return {{0, 1, 2}, {value, value, value}};
}

} // namespace

TEST_CASE("frequency, damping ratio and settled value of a decaying oscillation are found again",
          "[verification]") {
  for (const double zeta : {0.0, 0.01, 0.03, 0.1})
    for (const double frequency : {3.3, 7.8}) {
      INFO("zeta " << zeta << ", " << frequency << " Hz");
      const auto swings = compare::swings_of(released(-6.64, zeta, frequency));
      REQUIRE(swings);
      CHECK(swings->frequency ==
            Approx(frequency).epsilon(2e-3)); // a dozen values a swing, parabolas between
      CHECK(swings->damping_ratio == Approx(zeta).margin(1e-3));
      CHECK(swings->settled == Approx(-6.64).epsilon(5e-3));
    }
}

TEST_CASE("noise below a twentieth of the range makes no extremes") {
  TimeSeries series = released(10, 0.02, 4);
  const std::size_t n = compare::extremes(series).size();
  CHECK(n == 15); // 16 half swings, less the first, which begins at an end
  for (std::size_t i = 0; i < series.value.size(); ++i) series.value[i] += i % 2 == 0 ? 0.2 : -0.2;
  CHECK(compare::extremes(series).size() == n);
}

TEST_CASE("peak and overshoot are of the parabola through three values") {
  const TimeSeries series = released(2, 0.05, 4);
  const double peak_time = 0.125 - std::asin(0.05) / (tau * 4); // where the velocity is zero
  const double left = std::exp(-0.05 / std::sqrt(1 - 0.05 * 0.05) * tau / 2);
  CHECK(compare::value_over_time(OverTime::peak_time, series).value() == Approx(peak_time).margin(1e-3));
  CHECK(compare::value_over_time(OverTime::peak, series).value() == Approx(2 * (1 + left)).epsilon(2e-3));
  CHECK(compare::value_over_time(OverTime::overshoot, series).value() == Approx(100 * left).epsilon(1e-2));
}

TEST_CASE("what does not swing has no frequency, settles at its end, and may have no overshoot") {
  for (const auto what : {OverTime::frequency, OverTime::damping_ratio, OverTime::overshoot})
    CHECK_FALSE(compare::value_over_time(what, constant(3)));
  CHECK(compare::value_over_time(OverTime::settled, constant(3)) == 3);
  const TimeSeries creeping{{0, 1, 2, 3}, {0, 4, 6, 7}};
  CHECK(compare::value_over_time(OverTime::end, creeping) == 7);
  CHECK(compare::value_over_time(OverTime::overshoot, creeping) == 0);
  CHECK(compare::value_over_time(OverTime::peak_time, creeping) == 3);
  CHECK_FALSE(compare::value_over_time(OverTime::frequency, creeping));
}

TEST_CASE("a trajectory's error is the root mean square of the difference over the reference's") {
  TimeSeries reference = released(2, 0.05, 4), other = reference;
  CHECK(compare::trajectory_error_percent(reference, other) == 0);
  for (double& value : other.value) value *= 1.1;
  CHECK(compare::trajectory_error_percent(reference, other).value() == Approx(10));
  CHECK(compare::value_over_time(OverTime::trajectory_l2, constant(-3)).value() == Approx(3));
  CHECK_FALSE(compare::trajectory_error_percent(constant(0), constant(1)));
}
