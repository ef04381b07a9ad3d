#include "cases/case/error.hpp"
#include "cases/case/readers.hpp"
#include "compare/fit/fit.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace springproof::compare {

namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// The first n parameters, then the others, as lists.
std::vector<double> part(const VectorXd& all, Index from, Index n) {
  return {all.data() + from, all.data() + from + n};
}

cases::Ogden ogden_of(CurveLaw law, const VectorXd& p) {
  if (law == CurveLaw::neo_hookean) return cases::mooney_rivlin(p[0] / 2, 0);
  if (law == CurveLaw::mooney_rivlin) return cases::mooney_rivlin(p[0], p[1]);
  const Index n = p.size() / 2;
  return {part(p, 0, n), part(p, n, n), std::nullopt};
}

msm::StressLaw stress_law(CurveLaw law, const VectorXd& p) {
  return law == CurveLaw::yeoh ? msm::yeoh_law(part(p, 0, p.size())) : msm::ogden_law(ogden_of(law, p));
}

/// Starts of the parameters from the shear modulus at rest. Ogden's alpha have several, for the sum of
/// squares has several minima in them.
std::vector<std::vector<FreeParameter>> starts_of(CurveLaw law, int n_terms, double shear_modulus) {
  switch (law) {
  case CurveLaw::neo_hookean:
    return {{{"shear_modulus", shear_modulus, 0}}};
  case CurveLaw::mooney_rivlin:
    return {{{"c10", shear_modulus / 4}, {"c01", shear_modulus / 4}}};
  case CurveLaw::yeoh: {
    std::vector<FreeParameter> all;
    for (int i = 1; i <= n_terms; ++i) all.push_back({fmt::format("c{}0", i), shear_modulus / 2});
    return {all};
  }
  case CurveLaw::ogden:
    break;
  }
  std::vector<std::vector<FreeParameter>> starts;
  for (const double first : {2., -2., 9., -9., 20., -20.}) {
    std::vector<FreeParameter> all;
    for (int i = 0; i < n_terms; ++i) all.push_back({fmt::format("mu[{}]", i), shear_modulus / n_terms});
    for (int i = 0; i < n_terms; ++i) // signs alternate, the later ones are larger
      all.push_back({fmt::format("alpha[{}]", i), first * (i % 2 == 0 ? 1 : -1) * (1 + i / 2)});
    starts.push_back(all);
  }
  return starts;
}

/// What a case says to have the law.
std::vector<std::string> settings_of(CurveLaw law, const VectorXd& p) {
  switch (law) {
  case CurveLaw::neo_hookean:
    return {fmt::format(R"(material={{model="neo_hookean", shear_modulus={:.8g}}})", p[0])};
  case CurveLaw::mooney_rivlin:
    return {fmt::format(R"(material={{model="mooney_rivlin", c10={:.8g}, c01={:.8g}}})", p[0], p[1])};
  case CurveLaw::yeoh: {
    if (!(p[0] > 0)) return {}; // no case takes it
    std::string terms;
    for (Index i = 0; i < p.size(); ++i) terms += fmt::format(", c{}0={:.8g}", i + 1, p[i]);
    return {fmt::format(R"(material={{model="yeoh"{}}})", terms)};
  }
  case CurveLaw::ogden:
    break;
  }
  const cases::Ogden ogden = ogden_of(law, p);
  return {fmt::format(R"(material={{model="ogden", mu=[{:.8g}], alpha=[{:.8g}]}})", fmt::join(ogden.mu, ", "),
                      fmt::join(ogden.alpha, ", "))};
}

} // namespace

Fit fit_curve(const msm::UniaxialCurve& curve, CurveLaw law, int n_terms, const std::string& name) {
  std::vector<double> strains, stresses; // strain 0 has stress 0 by every law
  for (std::size_t i = 0; i < curve.axial_strain.size(); ++i) {
    if (curve.axial_strain[i] == 0) continue;
    strains.push_back(curve.axial_strain[i]);
    stresses.push_back(curve.stress[i] * std::exp(2 * curve.lateral_strain[i])); // nominal
  }
  const auto n = static_cast<Index>(strains.size());
  const std::size_t nearest = static_cast<std::size_t>(
      std::min_element(strains.begin(), strains.end(),
                       [](double a, double b) { return std::abs(a) < std::abs(b); }) -
      strains.begin());
  const double shear_modulus = std::abs(stresses[nearest] / strains[nearest]) / 3;
  const auto starts = starts_of(law, n_terms, shear_modulus > 0 ? shear_modulus : 1);
  if (static_cast<std::size_t>(n) <= starts[0].size())
    throw cases::InputError(
        fmt::format("{}: has {} strains other than 0, must have more than the {} parameters "
                    "of {}: what is fitted exactly has no residuals to tell its error",
                    name, n, starts[0].size(), cases::name_of(law)));
  const VectorXd values = Eigen::Map<const VectorXd>(stresses.data(), n);
  const double size = values.norm() / std::sqrt(static_cast<double>(n));
  const Observations data{values, VectorXd::Constant(n, size), false};
  const Predict predict = [&](const std::vector<VectorXd>& choices) {
    std::vector<Prediction> all;
    for (const VectorXd& p : choices) {
      const msm::StressLaw stress = stress_law(law, p);
      Prediction& one = all.emplace_back(Prediction{VectorXd(n)});
      for (Index i = 0; i < n; ++i) {
        const double stretch = std::exp(strains[static_cast<std::size_t>(i)]);
        one.values[i] = stress(stretch) / stretch;
      }
      if (!one.values.allFinite()) one = {{}, "the law's stress is not finite"};
    }
    return all;
  };
  std::vector<bool> all(static_cast<std::size_t>(n), true);
  std::vector<int> groups;
  for (Index i = 0; i < n; ++i) groups.push_back(static_cast<int>(i));
  Fit best{cases::name_of(law), name, {}, {}};
  double least = INFINITY;
  for (const auto& start : starts) {
    const LeastSquaresProblem problem(start, data, predict);
    LeastSquares found = problem.fit(problem.start(), all);
    const double error = found.predicted.size() == 0 ? INFINITY : (found.predicted - values).norm();
    if (!(best.parameters.empty() || error < least * (1 - 1e-9))) continue;
    least = error;
    best.parameters = start;
    best.found = std::move(found);
    best.held_out = {};
    if (!best.found.has_values()) continue;
    best.held_out = cross_validate(problem, best.found, groups);
    best.held_out.start_error_percent.reset(); // no one's values
  }
  best.n_data = static_cast<std::size_t>(n);
  if (best.found.predicted.size() == 0) return best;
  best.measures = {
      {"nominal stress", best.n_data, prediction_error_percent(data, best.found.predicted, all)}};
  for (Index i = 0; i < n; ++i)
    best.rows.push_back({fmt::format("stretch {:.6g}", std::exp(strains[static_cast<std::size_t>(i)])),
                         "nominal stress", "MPa", 0, values[i], best.found.predicted[i]});
  if (best.found.has_values()) best.settings = settings_of(law, best.found.parameters);
  return best;
}

} // namespace springproof::compare
