#include "compare/fit/least_squares.hpp"

#include <catch2/catch.hpp>
#include <random>

using namespace springproof;
using namespace compare;
using Eigen::VectorXd;

namespace {

const VectorXd places = (VectorXd(6) << 1, 2, 3, 4, 5, 6).finished();
const VectorXd measured = (VectorXd(6) << 3.1, 4.9, 7.2, 8.8, 11.1, 12.9).finished();

Predict of_each(const std::function<VectorXd(const VectorXd&)>& model) {
  return [=](const std::vector<VectorXd>& choices) {
    std::vector<Prediction> all;
    for (const VectorXd& choice : choices) all.push_back({model(choice)});
    return all;
  };
}

const Predict line =
    of_each([](const VectorXd& p) -> VectorXd { return (p[0] + p[1] * places.array()).matrix(); });

std::vector<bool> all_of(const VectorXd& values) {
  return std::vector<bool>(static_cast<std::size_t>(values.size()), true);
}

} // namespace

TEST_CASE("a straight line has the intervals of textbooks", "[verification]") {
  const LeastSquaresProblem problem({{"a", 1}, {"b", 1}}, {measured, VectorXd::Ones(6), false}, line);
  const LeastSquares found = problem.fit(problem.start(), all_of(measured));
  REQUIRE(found.has_values());
  // b = Sxy/Sxx, its standard error sqrt(SSE/(n - 2)/Sxx), Student's 97.5 % quantile with 4 degrees 2.776445
  const double mean = places.mean(), sxx = (places.array() - mean).square().sum(),
               b = ((places.array() - mean) * measured.array()).sum() / sxx, a = measured.mean() - b * mean,
               sse = (measured.array() - a - b * places.array()).square().sum(),
               half = 2.776445 * std::sqrt(sse / 4 / sxx);
  const double left = 1e-3 * half; // by the minimisation
  CHECK(found.parameters[0] == Approx(a).margin(left));
  CHECK(found.parameters[1] == Approx(b).margin(left));
  CHECK(found.lower[1] == Approx(b - half).margin(left));
  CHECK(found.upper[1] == Approx(b + half).margin(left));
}

TEST_CASE("given standard deviations have normal intervals", "[verification]") {
  const LeastSquaresProblem problem({{"a", 1}, {"b", 1}}, {measured, VectorXd::Constant(6, 0.5), true}, line);
  const LeastSquares found = problem.fit(problem.start(), all_of(measured));
  REQUIRE(found.has_values());
  const double sxx = (places.array() - places.mean()).square().sum();
  CHECK(found.upper[1] - found.lower[1] == Approx(2 * 1.959964 * 0.5 / std::sqrt(sxx)).epsilon(1e-6));
}

TEST_CASE("of a hundred draws with 2 % noise 90 to 98 intervals cover the truth, and values err by 1 %",
          "[verification]") {
  std::mt19937 random(43);
  std::normal_distribution<double> noise(0, 1);
  // the bar's displacements at 20 places, along it and across, which its finite elements have to 1e-6
  // (fit_cases_test.cpp)
  const auto bar_at = [](const Eigen::VectorXd& p) {
    Eigen::VectorXd u(40);
    for (Eigen::Index i = 0; i < 20; ++i) {
      u[2 * i] = 0.01 / p[0] * static_cast<double>(i + 1) / 2;
      u[2 * i + 1] = -p[1] * u[2 * i];
    }
    return u;
  };
  const Predict predict = [&](const std::vector<Eigen::VectorXd>& choices) {
    std::vector<Prediction> all;
    for (const Eigen::VectorXd& choice : choices) all.push_back({bar_at(choice)});
    return all;
  };
  const Eigen::Vector2d truth(0.62, 0.41);
  const Eigen::VectorXd exact = bar_at(truth), deviations = 0.02 * exact.cwiseAbs();
  Eigen::Vector2d squares = Eigen::Vector2d::Zero();
  int covered[2] = {0, 0};
  for (int draw = 0; draw < 100; ++draw) {
    Eigen::VectorXd values = exact;
    for (Eigen::Index i = 0; i < values.size(); ++i) values[i] += deviations[i] * noise(random);
    const LeastSquaresProblem problem({{"E", 1, 0}, {"nu", 0.3, -1, 0.5}}, {values, deviations, true},
                                      predict);
    const LeastSquares found = problem.fit(problem.start(), std::vector<bool>(40, true));
    REQUIRE(found.has_values());
    for (Eigen::Index p = 0; p < 2; ++p)
      covered[p] += found.lower[p] <= truth[p] && truth[p] <= found.upper[p] ? 1 : 0;
    squares += (found.parameters.cwiseQuotient(truth) - Eigen::Vector2d::Ones()).cwiseAbs2();
  }
  for (Eigen::Index p = 0; p < 2; ++p) {
    CHECK(covered[p] >= 90);
    CHECK(covered[p] <= 98);
    CHECK(std::sqrt(squares[p] / 100) < 0.01);
  }
}

TEST_CASE("a product alone does not tell its factors", "[verification]") {
  const Predict product = of_each([](const VectorXd& p) -> VectorXd { return p[0] * p[1] * places; });
  const LeastSquaresProblem problem({{"youngs_modulus", 2, 0}, {"area", 3}},
                                    {measured, VectorXd::Ones(6), false}, product);
  const LeastSquares found = problem.fit(problem.start(), all_of(measured));
  REQUIRE(found.undetermined.size() == 1);
  CHECK_THAT(found.undetermined[0], Catch::Contains("youngs_modulus") && Catch::Contains("area"));
  CHECK(found.lower.size() == 0);
  CHECK_FALSE(found.has_values());
}

TEST_CASE("a combination whose interval is wider than its value is undetermined") {
  const LeastSquaresProblem problem({{"a", 1}, {"b", 1}}, {measured, VectorXd::Constant(6, 10), true}, line);
  const LeastSquares found = problem.fit(problem.start(), all_of(measured));
  CHECK_FALSE(found.undetermined.empty());
}

TEST_CASE("a positive parameter is found from far away, and its interval is positive") {
  const Predict inverse = of_each([](const VectorXd& p) -> VectorXd { return places / p[0]; });
  const LeastSquaresProblem problem({{"youngs_modulus", 1000, 0}}, {measured, VectorXd::Ones(6), false},
                                    inverse);
  const LeastSquares found = problem.fit(problem.start(), all_of(measured));
  REQUIRE(found.has_values());
  CHECK(found.parameters[0] ==
        Approx(places.squaredNorm() / places.dot(measured)).margin(1e-3 * (found.upper[0] - found.lower[0])));
  CHECK(found.lower[0] > 0);
  CHECK(found.lower[0] < found.parameters[0]);
}

TEST_CASE("a value that runs to its end is no value") {
  const Predict model = of_each([](const VectorXd& p) -> VectorXd { return p[0] * places; });
  const LeastSquaresProblem problem({{"poissons_ratio", 0.3, -1, 0.5}},
                                    {0.6 * places, VectorXd::Ones(6), false}, model);
  const LeastSquares found = problem.fit(problem.start(), all_of(places));
  CHECK_THAT(found.failure, Catch::Contains("poissons_ratio runs to its end"));
}

TEST_CASE("a model without an answer at the start has its reason") {
  const Predict none = [](const std::vector<VectorXd>& choices) {
    return std::vector<Prediction>(choices.size(), {{}, "the bar breaks"});
  };
  const LeastSquaresProblem problem({{"a", 1}}, {measured, VectorXd::Ones(6), false}, none);
  CHECK(problem.fit(problem.start(), all_of(measured)).failure == "the bar breaks");
}

TEST_CASE("a model without an answer beside the start has its reason") {
  const Predict only_at_start = [](const std::vector<VectorXd>& choices) {
    std::vector<Prediction> all;
    for (const VectorXd& choice : choices)
      all.push_back(choice[0] == 1 ? Prediction{VectorXd::Ones(6)} : Prediction{{}, "the bar breaks"});
    return all;
  };
  const LeastSquaresProblem problem({{"a", 1}}, {measured, VectorXd::Ones(6), false}, only_at_start);
  CHECK(problem.fit(problem.start(), all_of(measured)).failure == "the least squares failed: the bar breaks");
}

TEST_CASE("leaving out one datum after the other errs by what the others' means leave", "[verification]") {
  const VectorXd values = measured.head(5);
  const Predict constant = of_each([](const VectorXd& p) -> VectorXd { return VectorXd::Constant(5, p[0]); });
  const LeastSquaresProblem problem({{"a", 1}}, {values, VectorXd::Ones(5), false}, constant);
  const LeastSquares found = problem.fit(problem.start(), all_of(values));
  const HeldOut held = cross_validate(problem, found, {0, 1, 2, 3, 4});
  REQUIRE(held.error_percent);
  CHECK(held.how == "5-fold");
  // the mean of the others is off by n/(n - 1) of the residual
  const double residual = (values.array() - values.mean()).matrix().norm() * 5 / 4;
  CHECK(*held.error_percent == Approx(100 * residual / values.norm()).epsilon(1e-6));
}

TEST_CASE("too few data leave nothing to hold out, and say so") {
  const VectorXd values = measured.head(2);
  const Predict model =
      of_each([](const VectorXd& p) -> VectorXd { return (p[0] + p[1] * places.head(2).array()).matrix(); });
  const LeastSquaresProblem problem({{"a", 1}, {"b", 1}}, {values, VectorXd::Constant(2, 0.1), true}, model);
  const LeastSquares found = problem.fit(problem.start(), all_of(values));
  const HeldOut held = cross_validate(problem, found, {0, 1});
  CHECK_FALSE(held.error_percent);
  CHECK_THAT(held.reason, Catch::Contains("too few"));
}

TEST_CASE("noisy answers have the line's minimum, and derivatives by a step that their noise asks for") {
  constexpr double noise = 1e-4; // their size is 8
  const Predict rough = of_each([&](const VectorXd& p) -> VectorXd {
    VectorXd values = p[0] + p[1] * places.array();
    std::mt19937 random(static_cast<unsigned>(std::hash<double>{}(p[0] + 3 * p[1])));
    std::normal_distribution<double> error(0, 8.6 * noise);
    for (double& value : values) value += error(random);
    return values;
  });
  const LeastSquaresProblem problem({{"a", 1.5}, {"b", 1.5}}, {measured, VectorXd::Ones(6), false}, rough,
                                    Smoothness::noisy);
  const LeastSquares found = problem.fit(problem.start(), all_of(measured));
  INFO(found.failure);
  REQUIRE(found.has_values());
  const LeastSquares exact =
      LeastSquaresProblem({{"a", 1}, {"b", 1}}, {measured, VectorXd::Ones(6), false}, line)
          .fit(Eigen::Vector2d(1, 1), all_of(measured));
  CHECK(found.noise.value() == Approx(noise).epsilon(0.5)); // there are 18 fourth differences
  CHECK(found.step == Approx(std::cbrt(*found.noise)));
  for (Eigen::Index p = 0; p < 2; ++p) {
    const double half = (exact.upper[p] - exact.lower[p]) / 2;
    CHECK(std::abs(found.parameters[p] - exact.parameters[p]) < 0.1 * half);
    CHECK((found.upper[p] - found.lower[p]) / 2 == Approx(half).epsilon(0.05));
  }
}
