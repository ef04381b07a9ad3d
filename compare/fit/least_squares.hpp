#pragma once

#include <Eigen/Core>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

/// Least squares that also tell what the data do not determine: the mathematics of `springproof fit`.
namespace springproof::compare {

/// A number that data are to tell. Where `lowest` is 0 its logarithm is fitted, and its interval is positive.
struct FreeParameter {
  std::string name;
  double start;
  double lowest = -INFINITY, highest = INFINITY;
};

/// All data as a model has them with some values of the parameters, or why it has none.
struct Prediction {
  Eigen::VectorXd values;
  std::string failure{}; ///< empty where there are values
};
/// Predicts the data for several choices of the parameters, which may be solved side by side.
using Predict = std::function<std::vector<Prediction>(const std::vector<Eigen::VectorXd>& choices)>;

struct Observations {
  Eigen::VectorXd values;
  /// Standard deviations of the values where they are measured. Otherwise what the deviations are in
  /// proportion to; their common factor is estimated from the residuals.
  Eigen::VectorXd deviations;
  bool are_measured;
};

/// What answers of a model are as functions of its parameters.
enum class Smoothness {
  smooth, ///< to 1e-9 of their size, as our own solves are
  noisy   ///< as a client's, which may stop before it is at rest
};

/// A fit's values with what the data say about them.
struct LeastSquares {
  std::string failure{};                   ///< why there is none; empty where there is
  Eigen::VectorXd parameters;              ///< at the minimum
  Eigen::VectorXd lower, upper;            ///< ends of 95 % intervals; empty where the data leave some open
  std::vector<std::string> undetermined{}; ///< combinations of the parameters that the data leave open
  /// Singular values belong to the Jacobian whose columns are relative changes of the parameters, and whose
  /// rows are divided by the data's standard deviations; descending. A combination has the relative standard
  /// deviation 1/s.
  std::vector<double> singular_values{};
  Eigen::VectorXd predicted;   ///< all data, those too that were left out
  double deviation_factor = 1; ///< standard deviations in units of Observations::deviations; 1 where measured
  std::optional<double> noise{}; ///< scatter of noisy answers, over their size
  double step = 0.001;           ///< relative change of a parameter, of which derivatives are differences
  bool has_values() const { return failure.empty() && undetermined.empty(); }
};

class LeastSquaresProblem {
 public:
  LeastSquaresProblem(std::vector<FreeParameter> parameters, Observations data, Predict predict,
                      Smoothness smoothness = Smoothness::smooth);

  /// Minimises the sum of squared residuals by Levenberg and Marquardt's method (Ceres), with derivatives by
  /// central differences; where answers are noisy by BOBYQA (NLopt; Powell 2009), without derivatives.
  /// Intervals are those of the linearised model: Student's with the residuals'
  /// variance, normal where deviations are measured.
  ///
  /// A combination of parameters is undetermined when its interval is wider than the parameters themselves,
  /// or its singular value is below 1e-5 of the largest one, where differences tell nothing; with noisy
  /// answers below noise/step. Their noise is measured at the minimum by fourth differences of seven answers
  /// (Moré and Wild 2011, SIAM J Sci Comput 33:1292), and the step of derivatives is its cube root, from
  /// 0.001 to 0.1: the errors by noise and by the third derivative are then alike.
  /// @param is_used  the data that are fitted; the others are predicted alone
  LeastSquares fit(const Eigen::VectorXd& start, const std::vector<bool>& is_used) const;

  /// Predicts the data; what was predicted before is remembered.
  Prediction predict(const Eigen::VectorXd& parameters) const;
  Eigen::VectorXd start() const;
  std::size_t n_predicted() const { return known_.size(); } ///< choices of the parameters so far
  const std::vector<FreeParameter>& parameters() const { return parameters_; }
  const Observations& data() const { return data_; }

 private:
  struct Cost;
  struct Linearised;
  struct Search;
  double size_of(Eigen::Index parameter) const;
  Eigen::VectorXd scaled(const Eigen::VectorXd& parameters) const;
  Eigen::VectorXd unscaled(const Eigen::VectorXd& coordinates) const;
  std::vector<Prediction> remembered(const std::vector<Eigen::VectorXd>& choices) const;
  Linearised linearise(const Eigen::VectorXd& coordinates, double step) const;
  std::optional<double> noise_near(const Eigen::VectorXd& coordinates,
                                   const std::vector<Eigen::Index>& places) const;
  Search descend(Eigen::VectorXd& coordinates, const std::vector<Eigen::Index>& places,
                 const Eigen::VectorXd& least, const Eigen::VectorXd& most) const;
  Search search_without_derivatives(Eigen::VectorXd& coordinates, const std::vector<Eigen::Index>& places,
                                    const Eigen::VectorXd& least, const Eigen::VectorXd& most) const;
  void judge(LeastSquares& found, const Eigen::VectorXd& coordinates, const std::vector<bool>& is_used) const;

  std::vector<FreeParameter> parameters_;
  Observations data_;
  Predict predict_;
  Smoothness smoothness_;
  mutable std::map<std::vector<double>, Prediction> known_;
};

/// The error of predictions, percent: root of the mean of ((prediction - value)/deviation)² over those data,
/// by that of (value/deviation)².
std::optional<double> prediction_error_percent(const Observations& data, const Eigen::VectorXd& predicted,
                                               const std::vector<bool>& is_meant);

/// What a fit errs by on data that it did not see.
struct HeldOut {
  std::string how;                             ///< "named", "5-fold"; empty: nothing could be
  std::string reason;                          ///< why there is no error; empty where there is
  std::optional<double> error_percent{};       ///< with the fitted values
  std::optional<double> start_error_percent{}; ///< with those of the start
};

/// Holds out one part of the data after the other, and fits the others.
/// @param group_of  data that are held out together, from 0   @param fitted  the fit to all data
HeldOut cross_validate(const LeastSquaresProblem& problem, const LeastSquares& fitted,
                       const std::vector<int>& group_of);

} // namespace springproof::compare
