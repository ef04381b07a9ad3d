#include "msm/design/nonlinear_method.hpp"

#include "cases/case/error.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <ceres/ceres.h>
#include <cmath>
#include <limits>
#include <numeric>

namespace springproof::msm {

namespace {

double norm(const std::vector<double>& values) {
  return std::sqrt(std::inner_product(values.begin(), values.end(), values.begin(), 0.0));
}

/// Both residuals of one strain. The width comes from a solve in doubles; one more Newton step in the
/// differentiating numbers gives it its derivatives (the implicit function theorem).
struct StrainResidual {
  double strain, stress, lateral, stress_norm, lateral_norm, edge, unit;

  template<class Number>
  bool operator()(const Number* scaled, Number* residual) const {
    using ceres::log;
    using std::log;
    const Number k[] = {unit * scaled[0], unit * scaled[1], unit * scaled[2]};
    const double z = std::exp(strain);
    const double x0 = width(k);
    if (!(x0 > 0)) return false;
    const Number guess(x0);
    const Number x = guess - lateral_imbalance(k, guess, z) / lateral_imbalance_slope(k, guess, z);
    residual[0] = (axial_stress(k, x, z, edge) - stress) / stress_norm;
    residual[1] = (log(x) - lateral) / lateral_norm;
    return true;
  }

 private:
  template<class Number>
  double width(const Number* k) const {
    const auto value = [](const Number& number) {
      if constexpr (std::is_same_v<Number, double>)
        return number;
      else
        return number.a;
    };
    try {
      return lateral_stretch({value(k[0]), value(k[1]), value(k[2]), 0}, std::exp(strain));
    } catch (const cases::SolveError&) {
      return 0; // no value of the objective here, for Ceres
    }
  }
};

/// Springs have the size of E L0, E the secant modulus of the reference's largest strain.
double stiffness_unit(const UniaxialCurve& reference, double edge) {
  const auto largest = std::max_element(reference.axial_strain.begin(), reference.axial_strain.end(),
                                        [](double a, double b) { return std::abs(a) < std::abs(b); });
  const auto at = static_cast<std::size_t>(largest - reference.axial_strain.begin());
  return std::abs(reference.stress[at] / *largest) * edge;
}

StrainResidual residual_at(const UniaxialCurve& reference, std::size_t i, double edge, double unit) {
  const auto& [strain, stress, lateral] = reference;
  return {strain[i], stress[i], lateral[i], norm(stress), norm(lateral), edge, unit};
}

void check(const UniaxialCurve& reference) {
  if (!(norm(reference.stress) > 0)) throw cases::InputError("the reference curve's stresses are all zero");
  if (!(norm(reference.lateral_strain) > 0))
    throw cases::InputError(
        "the reference curve has no lateral strain (nu = 0): the objective (thesis eq. 5.9) divides by it");
}

struct Minimum {
  std::array<double, 3> scaled;
  double objective;
  bool converged;
};

Minimum minimise(const UniaxialCurve& reference, double edge, double unit, std::array<double, 3> start) {
  ceres::Problem problem;
  problem.AddParameterBlock(start.data(), 3);
  for (std::size_t i = 0; i < reference.axial_strain.size(); ++i) {
    if (reference.axial_strain[i] == 0) continue; // a cell at rest has neither stress nor strain
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<StrainResidual, 2, 3>(
                                 new StrainResidual(residual_at(reference, i, edge, unit))),
                             nullptr, start.data());
  }
  for (int c = 0; c < 3; ++c) problem.SetParameterLowerBound(start.data(), c, 0);
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.num_threads = 1;
  options.max_num_iterations = 2000; // the valley is flat: hundreds of steps from a bad start
  options.function_tolerance = 1e-10;
  options.gradient_tolerance = 1e-11;
  options.parameter_tolerance = 1e-10;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return {start, 2 * summary.final_cost, summary.IsSolutionUsable()};
}

/// Equal stiffnesses, each kind of spring dominant, and two far corners.
constexpr std::array<std::array<double, 3>, 6> starts = {
    {{0.2, 0.2, 0.2}, {1, 0.05, 0.05}, {0.05, 1, 0.05}, {0.05, 0.05, 1}, {1, 1, 0.05}, {2, 2, 2}}};

} // namespace

Eigen::VectorXd uniaxial_residuals(const CellStiffness& stiffness, double edge,
                                   const UniaxialCurve& reference, Eigen::MatrixX3d* jacobian) {
  check(reference);
  const auto n = static_cast<Eigen::Index>(reference.axial_strain.size());
  Eigen::VectorXd residuals(2 * n);
  if (jacobian != nullptr) jacobian->resize(2 * n, 3);
  for (Eigen::Index i = 0; i < n; ++i) {
    using Jet = ceres::Jet<double, 3>;
    const Jet k[] = {Jet(stiffness.edge, 0), Jet(stiffness.face_diagonal, 1),
                     Jet(stiffness.internal_diagonal, 2)};
    Jet pair[2];
    if (!residual_at(reference, static_cast<std::size_t>(i), edge, 1)(k, pair))
      throw cases::SolveError("uniaxial test of one cell: no width is in equilibrium with these stiffnesses",
                              0, 0);
    residuals(i) = pair[0].a;
    residuals(n + i) = pair[1].a;
    if (jacobian == nullptr) continue;
    jacobian->row(i) = pair[0].v.transpose();
    jacobian->row(n + i) = pair[1].v.transpose();
  }
  return residuals;
}

double uniaxial_objective(const CellStiffness& stiffness, double edge, const UniaxialCurve& reference) {
  return uniaxial_residuals(stiffness, edge, reference).squaredNorm();
}

NonlinearFit nonlinear_method(const UniaxialCurve& reference, double edge) {
  check(reference);
  const double unit = stiffness_unit(reference, edge);
  NonlinearFit fit{{}, std::numeric_limits<double>::infinity(), {}};
  for (const auto& start : starts) {
    const Minimum minimum = minimise(reference, edge, unit, start);
    if (!minimum.converged) continue;
    const auto& [edges, face_diagonals, internal_diagonals] = minimum.scaled;
    fit.minimisers.push_back({unit * edges, unit * face_diagonals, unit * internal_diagonals, 0});
    if (!(minimum.objective < fit.objective)) continue;
    fit.objective = minimum.objective;
    fit.stiffness = fit.minimisers.back();
  }
  if (fit.minimisers.empty())
    throw cases::SolveError("nonlinear method: the minimisation converged from no start", 0, 0);
  return fit;
}

Identifiability identifiability(const CellStiffness& stiffness, double edge, const UniaxialCurve& reference) {
  Eigen::MatrixX3d jacobian;
  uniaxial_residuals(stiffness, edge, reference, &jacobian);
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(jacobian * stiffness_unit(reference, edge),
                                              Eigen::ComputeThinV);
  const Eigen::Vector3d values = svd.singularValues();
  return {values, svd.matrixV(), values(0) / values(2)};
}

} // namespace springproof::msm
