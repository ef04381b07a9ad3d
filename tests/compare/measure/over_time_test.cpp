#include "compare/measure/over_time.hpp"

#include "cases/case/names.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

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

namespace {

constexpr auto nan_value = std::numeric_limits<double>::quiet_NaN();
const std::vector<OverTime> all_numbers{OverTime::end,           OverTime::settled,      OverTime::peak,
                                        OverTime::peak_time,     OverTime::overshoot,    OverTime::frequency,
                                        OverTime::damping_ratio, OverTime::trajectory_l2};

/// Which numbers a series has. Those are finite.
std::vector<OverTime> numbers_of(const TimeSeries& series) {
  std::vector<OverTime> there;
  for (const OverTime what : all_numbers) {
    const auto number = compare::number_over_time(what, series);
    INFO(cases::name_of(what) << " of " << series.value.size() << " values");
    if (std::holds_alternative<std::string>(number)) continue;
    CHECK(std::isfinite(std::get<double>(number)));
    there.push_back(what);
  }
  return there;
}

TimeSeries with_value(TimeSeries series, std::size_t at, double value) {
  series.value[at] = value;
  return series;
}

/// Values between -1 and 1 of a generator that is the same everywhere.
TimeSeries noise(std::size_t n) {
  TimeSeries series;
  unsigned state = 1;
  for (std::size_t i = 0; i < n; ++i) {
    state = state * 1664525u + 1013904223u; // Numerical Recipes
    series.time.push_back(0.01 * static_cast<double>(i));
    series.value.push_back(state / 2147483648.0 - 1);
  }
  return series;
}

} // namespace

TEST_CASE("a number that a series does not have is missing with a reason, neither zero nor a NaN") {
  const std::vector<OverTime> of_rest{OverTime::end, OverTime::settled, OverTime::peak,
                                      OverTime::trajectory_l2};
  CHECK(numbers_of(constant(3)) == of_rest);
  CHECK(numbers_of(constant(0)) == of_rest);
  CHECK(numbers_of({{0}, {3}}) == of_rest);        // a single value
  CHECK(numbers_of({{0, 1}, {0, 3}}).size() == 6); // a way: no swings
  const TimeSeries creeping{{0, 1, 2, 3}, {0, 4, 6, 7}};
  CHECK(numbers_of(creeping).size() == 6);
  CHECK_THAT(std::get<std::string>(compare::number_over_time(OverTime::frequency, creeping)),
             Catch::Contains("does not swing"));
  CHECK(numbers_of(released(2, 0.05, 4)) == all_numbers);
  CHECK(numbers_of(released(2, 0.9, 4)).size() == 6); // swings that are gone at once
}

TEST_CASE("a series with a value that is no number has none but its end") {
  const TimeSeries whole = released(2, 0.05, 4);
  for (const double wrong : {nan_value, std::numeric_limits<double>::infinity()})
    for (const std::size_t at : {std::size_t{0}, std::size_t{1}, std::size_t{100}, whole.value.size() - 1}) {
      INFO(wrong << " at " << at);
      const TimeSeries broken = with_value(whole, at, wrong);
      const bool is_at_end = at + 1 == whole.value.size();
      CHECK(numbers_of(broken) == (is_at_end ? std::vector<OverTime>() : std::vector{OverTime::end}));
      CHECK_FALSE(compare::swings_of(broken));
      CHECK_FALSE(compare::trajectory_error_percent(whole, broken));
      CHECK_FALSE(compare::trajectory_error_percent(broken, whole));
    }
}

TEST_CASE("what settles where it began has no overshoot, up to rounding") {
  TimeSeries back{{0, 1, 2, 3}, {0, 1, 0.5, 1e-12}};
  CHECK_FALSE(compare::value_over_time(OverTime::overshoot, back)); // 1e14 %
  back.value.back() = 0.25;
  CHECK(compare::value_over_time(OverTime::overshoot, back).value() ==
        Approx(100 * (1 + 1 / 48. - 0.25) / 0.25)); // the parabola's vertex
}

TEST_CASE("noise has no frequency, and hides none that is larger") {
  const TimeSeries white = noise(400);
  CHECK(compare::extremes(white).size() > 100); // every few values one: beyond a twentieth of the range
  CHECK_FALSE(compare::value_over_time(OverTime::frequency, white));
  CHECK_FALSE(compare::value_over_time(OverTime::damping_ratio, white));
  CHECK_THAT(std::get<std::string>(compare::number_over_time(OverTime::frequency, white)),
             Catch::Contains("fewer than four steps"));
  CHECK(compare::value_over_time(OverTime::settled, white) == white.value.back());
  // a swing of eight steps is found beneath noise of a fiftieth of its range
  TimeSeries swinging = noise(200);
  for (std::size_t i = 0; i < swinging.value.size(); ++i)
    swinging.value[i] = 0.02 * swinging.value[i] + std::sin(tau * swinging.time[i] / 0.08);
  CHECK(compare::value_over_time(OverTime::frequency, swinging).value() ==
        Approx(12.5).epsilon(0.01)); // 24 swings, whose ends are known to a fraction of a step
}

TEST_CASE("rounding that does not swing has no frequency") {
  TimeSeries still = constant(0);
  still.value = {0, 1e-17, 0};
  CHECK_FALSE(compare::value_over_time(OverTime::frequency, still));
}
