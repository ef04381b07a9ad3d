#include "mechanics/dynamics/fading_memory.hpp"
#include "tests/support/creep.hpp"

#include <catch2/catch.hpp>
#include <complex>

using namespace springproof;
using mechanics::FadingMemory;
using mechanics::Vector;

namespace {

Vector number(double value) {
  return Vector::Constant(1, value);
}

/// The whole of a number, s + sum q, at the end of a step.
double whole(FadingMemory& memory, double at, double step) {
  memory.set_step(step);
  const double all = memory.factor()[0] * at + memory.remembered()[0];
  memory.end_step(number(at), step);
  return all;
}

} // namespace

TEST_CASE("a number that grows and is held relaxes as its branches say, whatever the steps",
          "[verification]") {
  const std::vector<FadingMemory::Branch> branches{{0.1, number(0.25)}, {0.7, number(0.5)}};
  FadingMemory memory(branches);
  double time = 0;
  for (const double step : {0.02, 0.03, 0.001, 0.2, 1., 0.01}) { // a step ends with the growth, at 0.05 s
    time += step;
    const double exact = creep::stress(time, 0.05, 0.25, 0.1) + creep::stress(time, 0.05, 0.5, 0.7) -
                         std::min(time / 0.05, 1.);
    CHECK(whole(memory, std::min(time / 0.05, 1.), step) == Approx(exact).epsilon(1e-12)); // rounding
  }
}

TEST_CASE("a number that swings has the storage and loss of its branches, at the order 2", "[verification]") {
  constexpr double omega = 12, part = 0.3, tau = 0.1;
  const std::complex<double> i_omega_tau(0, omega * tau),
      modulus = 1. + part * i_omega_tau / (1. + i_omega_tau);
  const auto error = [&](int n) { // steps of a period, after twenty periods: exp(-20 2 pi/1.2) is 1e-45
    FadingMemory memory({{tau, number(part)}});
    const double step = 2 * M_PI / omega / n;
    std::complex<double> sum = 0;
    for (int s = 1; s <= 21 * n; ++s) {
      const double phase = omega * s * step, all = whole(memory, std::sin(phase), step);
      if (s > 20 * n) sum += 2. / n * all * std::complex<double>(std::sin(phase), std::cos(phase));
    }
    return std::abs(sum - modulus);
  };
  CHECK(error(2000) <= 1e-6);
  CHECK(std::log2(error(50) / error(100)) == Approx(2).margin(0.05));
}

TEST_CASE("a memory begins relaxed, and nothing is remembered in the end") {
  FadingMemory memory({{0.1, number(0.25)}});
  memory.begin(number(3));
  for (const double duration : {1e-12, 0.1, 1e3}) {
    memory.set_step(duration);
    CHECK(memory.factor()[0] * 3 + memory.remembered()[0] ==
          Approx(3).epsilon(1e-13)); // it stays where it was
  }
  memory.end_step(number(5), 0.1);
  memory.set_step(INFINITY);
  CHECK(memory.factor()[0] == 1);
  CHECK(memory.remembered()[0] == 0);
}

TEST_CASE("a case's moduli are those of the end: branches are parts of them") {
  cases::Case definition;
  definition.material_dynamics.prony = {{0.2, 0.1, 0.5}, {0.3, 0, 2}};
  cases::RegionMaterial region;
  region.dynamics.prony = {{0.5, 0.5, 2}};
  definition.region_materials = {region};
  const auto branches = mechanics::prony_branches(definition);
  REQUIRE(branches.size() == 2);
  CHECK(branches[0].tau == 0.5);
  CHECK(branches[0].of_material[0].g == Approx(0.2 / 0.5));
  CHECK(branches[0].of_material[0].k == Approx(0.1 / 0.9));
  CHECK(branches[0].of_material[1].g == 0);
  CHECK(branches[1].of_material[0].g == Approx(0.3 / 0.5));
  CHECK(branches[1].of_material[0].k == 0);
  CHECK(branches[1].of_material[1].g == Approx(1));
}
