#include "compare/fit/least_squares.hpp"

#include "mechanics/dense.hpp"
#include "msm/design/minimise.hpp"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <fmt/format.h>
#include <memory>
#include <nlopt.h>
#include <utility>

namespace springproof::compare {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

std::vector<double> listed(const VectorXd& values) {
  return {values.data(), values.data() + values.size()};
}

std::vector<Index> places_of(const std::vector<bool>& is_meant) {
  std::vector<Index> places;
  for (std::size_t i = 0; i < is_meant.size(); ++i)
    if (is_meant[i]) places.push_back(static_cast<Index>(i));
  return places;
}

/// "+0.98 youngs_modulus -0.20 poissons_ratio": relative changes that go together.
std::string combination(const VectorXd& direction, const std::vector<FreeParameter>& parameters) {
  std::string text;
  Index largest = 0;
  direction.cwiseAbs().maxCoeff(&largest);
  for (Index p = 0; p < direction.size(); ++p) {
    const double part = direction[p] * (direction[largest] > 0 ? 1 : -1);
    if (std::abs(part) < 0.05) continue;
    text += fmt::format("{}{:+.2f} {}", text.empty() ? "" : " ", part,
                        parameters[static_cast<std::size_t>(p)].name);
  }
  return text;
}

/// Half of a 95 % interval in standard deviations.
double half_width_of(bool are_measured, Index degrees_of_freedom) {
  if (are_measured) return quantile(boost::math::normal(), 0.975);
  return quantile(boost::math::students_t(static_cast<double>(degrees_of_freedom)), 0.975);
}

constexpr double smooth_step = 1e-3, largest_step = 0.1;

} // namespace

/// How the search for a minimum has ended.
struct LeastSquaresProblem::Search {
  bool is_usable, has_converged;
  std::string message;
};

/// The model near some values of the parameters, whose coordinates Ceres changes.
struct LeastSquaresProblem::Linearised {
  VectorXd values;          ///< empty: the model has no answer here
  Eigen::MatrixXd jacobian; ///< derivatives of the values by the coordinates
};

struct LeastSquaresProblem::Cost : ceres::CostFunction {
  Cost(const LeastSquaresProblem& all, std::vector<Index> used) : problem(all), places(std::move(used)) {
    set_num_residuals(static_cast<int>(places.size()));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(all.parameters_.size()));
  }
  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override {
    const auto n = static_cast<Index>(problem.parameters_.size());
    const VectorXd at = Eigen::Map<const VectorXd>(blocks[0], n);
    const VectorXd weights = problem.data_.deviations(places).cwiseInverse();
    Linearised model;
    if (jacobians && jacobians[0])
      model = problem.linearise(at, smooth_step);
    else
      model.values = problem.predict(problem.unscaled(at)).values;
    if (model.values.size() == 0) return false;
    Eigen::Map<VectorXd>(residuals, weights.size()) =
        (model.values(places) - problem.data_.values(places)).cwiseProduct(weights);
    if (!jacobians || !jacobians[0]) return true;
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    Eigen::Map<RowMajor>(jacobians[0], weights.size(), n) =
        weights.asDiagonal() * model.jacobian(places, Eigen::all);
    return true;
  }
  const LeastSquaresProblem& problem;
  std::vector<Index> places;
};

LeastSquaresProblem::LeastSquaresProblem(std::vector<FreeParameter> parameters, Observations data,
                                         Predict predict, Smoothness smoothness)
    : parameters_(std::move(parameters)), data_(std::move(data)), predict_(std::move(predict)),
      smoothness_(smoothness) {}

VectorXd LeastSquaresProblem::start() const {
  VectorXd all(static_cast<Index>(parameters_.size()));
  for (Index p = 0; p < all.size(); ++p) all[p] = parameters_[static_cast<std::size_t>(p)].start;
  return all;
}

double LeastSquaresProblem::size_of(Index parameter) const {
  const double start = std::abs(parameters_[static_cast<std::size_t>(parameter)].start);
  return start > 0 ? start : 1;
}

VectorXd LeastSquaresProblem::scaled(const VectorXd& parameters) const {
  VectorXd coordinates = parameters;
  for (Index p = 0; p < parameters.size(); ++p) {
    coordinates[p] /= size_of(p);
    if (parameters_[static_cast<std::size_t>(p)].lowest == 0) coordinates[p] = std::log(coordinates[p]);
  }
  return coordinates;
}

VectorXd LeastSquaresProblem::unscaled(const VectorXd& coordinates) const {
  VectorXd parameters = coordinates;
  for (Index p = 0; p < parameters.size(); ++p) {
    if (parameters_[static_cast<std::size_t>(p)].lowest == 0) parameters[p] = std::exp(parameters[p]);
    parameters[p] *= size_of(p);
  }
  return parameters;
}

std::vector<Prediction> LeastSquaresProblem::remembered(const std::vector<VectorXd>& choices) const {
  std::vector<VectorXd> unknown;
  for (const VectorXd& choice : choices)
    if (known_.count(listed(choice)) == 0) unknown.push_back(choice);
  const std::vector<Prediction> fresh = unknown.empty() ? std::vector<Prediction>() : predict_(unknown);
  for (std::size_t i = 0; i < fresh.size(); ++i) known_[listed(unknown[i])] = fresh[i];
  std::vector<Prediction> all;
  for (const VectorXd& choice : choices) all.push_back(known_.at(listed(choice)));
  return all;
}

Prediction LeastSquaresProblem::predict(const VectorXd& parameters) const {
  return remembered({parameters}).front();
}

LeastSquaresProblem::Linearised LeastSquaresProblem::linearise(const VectorXd& coordinates,
                                                               double step) const {
  const Index n = coordinates.size();
  const VectorXd at = unscaled(coordinates);
  std::vector<VectorXd> choices{at};
  VectorXd steps(n);
  for (Index p = 0; p < n; ++p) {
    const FreeParameter& parameter = parameters_[static_cast<std::size_t>(p)];
    // With smooth_step derivatives err by 1e-6 of themselves: by the solves, 1e-9, and by the differences,
    // which are of second order.
    steps[p] = step;
    if (parameter.lowest != 0) { // a step stays away from the ends, where a model may have a pole
      const double distance = std::min(at[p] - parameter.lowest, parameter.highest - at[p]) / size_of(p);
      steps[p] = std::min(steps[p] * std::max(1., std::abs(coordinates[p])), 0.1 * distance);
    }
    for (const double sign : {1., -1.})
      choices.push_back(unscaled(coordinates + sign * steps[p] * VectorXd::Unit(n, p)));
  }
  const std::vector<Prediction> found = remembered(choices);
  if (!found[0].failure.empty()) return {};
  Linearised model{found[0].values, Eigen::MatrixXd(found[0].values.size(), n)};
  for (Index p = 0; p < n; ++p) {
    // Where one side has no answer, the difference is one-sided.
    const Prediction &above = found[static_cast<std::size_t>(1 + 2 * p)],
                     &below = found[static_cast<std::size_t>(2 + 2 * p)];
    const int sides = (above.failure.empty() ? 1 : 0) + (below.failure.empty() ? 1 : 0);
    if (sides == 0) return {};
    model.jacobian.col(p) = ((above.failure.empty() ? above.values : model.values) -
                             (below.failure.empty() ? below.values : model.values)) /
                            (sides * steps[p]);
  }
  return model;
}

std::optional<double> LeastSquaresProblem::noise_near(const VectorXd& coordinates,
                                                      const std::vector<Index>& places) const {
  constexpr Index n = 7, order = 4;
  constexpr double step = 1e-3; // what smooth answers change by in fourth order is below rounding
  std::vector<VectorXd> choices;
  for (Index k = 0; k < n; ++k)
    choices.push_back(unscaled(coordinates.array() + step * static_cast<double>(k - n / 2)));
  const VectorXd weights = data_.deviations(places).cwiseInverse();
  Eigen::MatrixXd answers(weights.size(), n);
  const std::vector<Prediction> found = remembered(choices);
  for (Index k = 0; k < n; ++k) {
    const Prediction& one = found[static_cast<std::size_t>(k)];
    if (!one.failure.empty()) return std::nullopt;
    answers.col(k) = one.values(places).cwiseProduct(weights);
  }
  const double size = answers.col(n / 2).norm();
  for (Index k = 0; k < order; ++k)
    answers = (answers.rightCols(answers.cols() - 1) - answers.leftCols(answers.cols() - 1)).eval();
  // A fourth difference has the variance of its parts times 1 + 16 + 36 + 16 + 1.
  return size > 0 ? answers.norm() / std::sqrt(70. * static_cast<double>(answers.cols())) / size : 0;
}

void LeastSquaresProblem::judge(LeastSquares& found, const VectorXd& coordinates,
                                const std::vector<bool>& is_used) const {
  const std::vector<Index> places = places_of(is_used);
  if (smoothness_ == Smoothness::noisy) {
    found.noise = noise_near(coordinates, places);
    found.step = std::clamp(std::cbrt(found.noise.value_or(1)), smooth_step, largest_step);
  }
  const Linearised model = linearise(coordinates, found.step);
  if (model.values.size() == 0 || (smoothness_ == Smoothness::noisy && !found.noise)) {
    found.failure = "the model has no answers beside the minimum";
    return;
  }
  const auto n = static_cast<Index>(parameters_.size());
  const auto n_free = static_cast<Index>(places.size()) - n;
  const VectorXd deviations = data_.deviations(places);
  const VectorXd residuals = (model.values(places) - data_.values(places)).cwiseQuotient(deviations);
  if (!data_.are_measured && n_free > 0)
    found.deviation_factor = residuals.norm() / std::sqrt(static_cast<double>(n_free));
  const double half_width = half_width_of(data_.are_measured, std::max<Index>(n_free, 1));
  VectorXd sizes = VectorXd::Ones(n); // a coordinate's change that counts as relative change 1
  for (Index p = 0; p < n; ++p)
    if (parameters_[static_cast<std::size_t>(p)].lowest != 0)
      sizes[p] = std::max(std::abs(coordinates[p]), 1.);
  // Without noise the data determine all that differences tell.
  const double factor = std::max(found.deviation_factor, 1e-12);
  const Eigen::MatrixXd relative = (deviations * factor).cwiseInverse().asDiagonal() *
                                   model.jacobian(places, Eigen::all) * sizes.asDiagonal();
  const mechanics::Spectrum parts = mechanics::right_singular(relative);
  Eigen::VectorXd values = Eigen::VectorXd::Zero(n);
  values.head(parts.values.size()) = parts.values;
  found.singular_values = listed(values);
  const double least = std::max(1e-5, found.noise.value_or(0) / found.step); // see linearise()
  VectorXd variance = VectorXd::Zero(n);
  for (Index k = 0; k < n; ++k) {
    const VectorXd direction = parts.vectors.col(k);
    if (!(values[k] > least * values[0] && values[k] > half_width))
      found.undetermined.push_back(combination(direction, parameters_));
    else
      variance += (direction.cwiseProduct(sizes) / values[k]).cwiseAbs2();
  }
  if (!found.undetermined.empty()) return;
  const VectorXd half = half_width * variance.cwiseSqrt();
  found.lower = unscaled(coordinates - half);
  found.upper = unscaled(coordinates + half);
  for (Index p = 0; p < n; ++p) {
    const FreeParameter& parameter = parameters_[static_cast<std::size_t>(p)];
    found.lower[p] = std::max(found.lower[p], parameter.lowest);
    found.upper[p] = std::min(found.upper[p], parameter.highest);
  }
}

LeastSquaresProblem::Search LeastSquaresProblem::descend(VectorXd& coordinates,
                                                         const std::vector<Index>& places,
                                                         const VectorXd& least, const VectorXd& most) const {
  ceres::Problem problem;
  problem.AddResidualBlock(new Cost(*this, places), nullptr, coordinates.data());
  for (Index p = 0; p < least.size(); ++p) {
    const auto place = static_cast<int>(p);
    if (std::isfinite(least[p])) problem.SetParameterLowerBound(coordinates.data(), place, least[p]);
    if (std::isfinite(most[p])) problem.SetParameterUpperBound(coordinates.data(), place, most[p]);
  }
  ceres::Solver::Options options;
  options.max_num_iterations = 50;
  options.max_num_consecutive_invalid_steps = 10;
  options.initial_trust_region_radius = 1e6; // nearly Gauss and Newton's step
  // A thousandth of a standard deviation; sums of squares change by rounding of solves below that.
  options.function_tolerance = 1e-6;
  options.parameter_tolerance = 1e-7; // what the noise of derivatives leaves
  const ceres::Solver::Summary summary = msm::minimise(problem, options);
  return {summary.IsSolutionUsable(), summary.termination_type == ceres::CONVERGENCE, summary.message};
}

LeastSquaresProblem::Search LeastSquaresProblem::search_without_derivatives(VectorXd& coordinates,
                                                                            const std::vector<Index>& places,
                                                                            const VectorXd& least,
                                                                            const VectorXd& most) const {
  struct Sum {
    const LeastSquaresProblem& problem;
    const std::vector<Index>& places;
    double largest = 0; ///< so far; a choice without an answer has twice it
  } sum{*this, places};
  const auto evaluate = [](unsigned n, const double* at, double*, void* data) {
    Sum& to = *static_cast<Sum*>(data);
    const Observations& wanted = to.problem.data_;
    const Prediction found =
        to.problem.predict(to.problem.unscaled(Eigen::Map<const VectorXd>(at, static_cast<Index>(n))));
    if (!found.failure.empty()) return 2 * to.largest;
    const double value = (found.values(to.places) - wanted.values(to.places))
                             .cwiseQuotient(wanted.deviations(to.places))
                             .squaredNorm();
    to.largest = std::max(to.largest, value);
    return value;
  };
  const auto n = static_cast<unsigned>(coordinates.size());
  const std::unique_ptr<nlopt_opt_s, void (*)(nlopt_opt)> search(nlopt_create(NLOPT_LN_BOBYQA, n),
                                                                 nlopt_destroy);
  nlopt_set_min_objective(search.get(), evaluate, &sum);
  nlopt_set_lower_bounds(search.get(), least.data());
  nlopt_set_upper_bounds(search.get(), most.data());
  nlopt_set_initial_step1(search.get(), 0.1); // relative changes
  nlopt_set_xtol_rel(search.get(), 1e-4);
  nlopt_set_ftol_rel(search.get(), 1e-8);
  nlopt_set_maxeval(search.get(), 200 * static_cast<int>(n));
  double smallest = 0;
  const nlopt_result end = nlopt_optimize(search.get(), coordinates.data(), &smallest);
  return {end > 0 || end == NLOPT_ROUNDOFF_LIMITED, end != NLOPT_MAXEVAL_REACHED,
          fmt::format("BOBYQA: {}", nlopt_result_to_string(end))};
}

LeastSquares LeastSquaresProblem::fit(const VectorXd& start, const std::vector<bool>& is_used) const {
  LeastSquares found;
  if (const Prediction first = predict(start); !first.failure.empty()) {
    found.failure = first.failure;
    return found;
  }
  VectorXd coordinates = scaled(start);
  const auto n = static_cast<Index>(parameters_.size());
  // A model may have a pole at an open end: a thousandth of what the start leaves is kept.
  VectorXd least = VectorXd::Constant(n, -INFINITY), most = -least;
  for (Index p = 0; p < n; ++p) {
    const FreeParameter& parameter = parameters_[static_cast<std::size_t>(p)];
    if (parameter.lowest == 0) continue;
    const auto inside = [&](double end) { return (end + 1e-3 * (parameter.start - end)) / size_of(p); };
    if (std::isfinite(parameter.lowest)) least[p] = inside(parameter.lowest);
    if (std::isfinite(parameter.highest)) most[p] = inside(parameter.highest);
  }
  const auto minimise = smoothness_ == Smoothness::smooth ? &LeastSquaresProblem::descend
                                                          : &LeastSquaresProblem::search_without_derivatives;
  const Search search = (this->*minimise)(coordinates, places_of(is_used), least, most);
  found.parameters = unscaled(coordinates);
  const Prediction last = predict(found.parameters);
  if (!search.is_usable || !last.failure.empty()) {
    std::string reason = last.failure;
    for (const auto& [values, prediction] : known_) // Ceres says no more than that one has no answer
      if (reason.empty()) reason = prediction.failure;
    found.failure = "the least squares failed: " + (reason.empty() ? search.message : reason);
    return found;
  }
  found.predicted = last.values;
  judge(found, coordinates, is_used);
  for (Index p = 0; p < n && found.has_values(); ++p)
    if (coordinates[p] <= least[p] || coordinates[p] >= most[p])
      found.failure = fmt::format("{} runs to its end, {:.6g}: no value inside fits the data best",
                                  parameters_[static_cast<std::size_t>(p)].name, found.parameters[p]);
  if (found.has_values() && !search.has_converged)
    found.failure = "the least squares have not converged: " + search.message;
  return found;
}

std::optional<double> prediction_error_percent(const Observations& data, const VectorXd& predicted,
                                               const std::vector<bool>& is_meant) {
  const std::vector<Index> places = places_of(is_meant);
  const VectorXd deviations = data.deviations(places);
  const VectorXd error = (predicted(places) - data.values(places)).cwiseQuotient(deviations);
  const double size = data.values(places).cwiseQuotient(deviations).norm();
  return size > 0 ? std::optional(100 * error.norm() / size) : std::nullopt;
}

HeldOut cross_validate(const LeastSquaresProblem& problem, const LeastSquares& fitted,
                       const std::vector<int>& group_of) {
  const int n_groups = 1 + *std::max_element(group_of.begin(), group_of.end());
  const int n_folds = std::min(5, n_groups);
  HeldOut held{fmt::format("{}-fold", n_folds), {}};
  const std::vector<bool> all(group_of.size(), true);
  VectorXd predicted = fitted.predicted;
  for (int fold = 0; fold < n_folds; ++fold) {
    std::vector<bool> is_used;
    for (const int group : group_of) is_used.push_back(group % n_folds != fold);
    const auto n_used = static_cast<std::size_t>(std::count(is_used.begin(), is_used.end(), true));
    if (n_used < problem.parameters().size() || n_folds < 2) {
      held.reason = fmt::format("{} data in {} groups are too few to hold any out for {} parameters: name "
                                "cases with --hold-out",
                                group_of.size(), n_groups, problem.parameters().size());
      return held;
    }
    const LeastSquares without = problem.fit(fitted.parameters, is_used);
    if (!without.has_values()) {
      held.reason = fmt::format("without fold {}: {}", fold + 1,
                                without.failure.empty() ? "the data left do not determine the parameters"
                                                        : without.failure);
      return held;
    }
    for (std::size_t i = 0; i < is_used.size(); ++i)
      if (!is_used[i]) predicted[static_cast<Index>(i)] = without.predicted[static_cast<Index>(i)];
  }
  held.error_percent = prediction_error_percent(problem.data(), predicted, all);
  held.start_error_percent =
      prediction_error_percent(problem.data(), problem.predict(problem.start()).values, all);
  return held;
}

} // namespace springproof::compare
