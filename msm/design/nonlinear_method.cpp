#include "cases/case/error.hpp"
#include "mechanics/dense.hpp"
#include "msm/design/minimise.hpp"
#include "msm/design/uniaxial.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace springproof::msm {

namespace {

/// Left side minus right side of eq. 5.3, N/mm; x = Lx/L0, z = Lz/L0.
template<class Number>
Number lateral_imbalance(const Number* k, const Number& x, double z) {
  using std::sqrt;
  const Number face = sqrt(2.0) * x / sqrt(x * x + z * z);           // sqrt2 sin a
  const Number internal = sqrt(3.0) * x / sqrt(2.0 * x * x + z * z); // sqrt6/2 sin b
  return x * (k[0] + 2.0 * k[1] + k[2]) - (k[0] + (1.0 + face) * k[1] + internal * k[2]);
}

/// Its derivative with respect to x.
double lateral_imbalance_slope(const double* k, double x, double z) {
  using Jet = ceres::Jet<double, 1>;
  const Jet constant[] = {Jet(k[0]), Jet(k[1]), Jet(k[2])};
  return lateral_imbalance(constant, Jet(x, 0), z).v[0];
}

/// See the declaration.  @param k  N/mm
template<class Number>
Number axial_stress(const Number* k, const Number& x, double z, double edge) {
  using std::sqrt;
  const Number cos_face = z / sqrt(x * x + z * z);
  const Number cos_internal = z / sqrt(2.0 * x * x + z * z);
  const Number force_per_edge = z * (k[0] + 2.0 * k[1] + k[2]) -
                                (k[0] + 2.0 * sqrt(2.0) * cos_face * k[1] + sqrt(3.0) * cos_internal * k[2]);
  return 4.0 * force_per_edge / (edge * x * x);
}

} // namespace

double lateral_stretch(const CellStiffness& stiffness, double stretch) {
  const std::array<double, 3> springs = stiffness.springs();
  const double* k = springs.data();
  // The imbalance grows from below zero to above it; next to x = 0 it may vanish too, without edges and face
  // diagonals.
  double low = 1e-6, high = 4 * std::max(1.0, stretch);
  if (!(lateral_imbalance(k, low, stretch) < 0 && lateral_imbalance(k, high, stretch) > 0))
    throw cases::SolveError("uniaxial test of one cell: no width is in equilibrium with these stiffnesses");
  double x = 1 / std::sqrt(stretch);
  for (int iteration = 0; iteration < 100; ++iteration) {
    const double imbalance = lateral_imbalance(k, x, stretch);
    (imbalance < 0 ? low : high) = x;
    double next = x - imbalance / lateral_imbalance_slope(k, x, stretch);
    if (!(next > low && next < high)) next = (low + high) / 2;
    if (std::abs(next - x) <= 1e-10 * x) return next; // it converges quadratically: this leaves round-off
    x = next;
  }
  return x;
}

UniaxialCurve uniaxial_response(const CellStiffness& stiffness, double edge,
                                const std::vector<double>& axial_strain) {
  UniaxialCurve curve;
  curve.axial_strain = axial_strain;
  for (const double strain : axial_strain) {
    const double z = std::exp(strain);
    const double x = lateral_stretch(stiffness, z);
    curve.stress.push_back(axial_stress(stiffness, x, z, edge));
    curve.lateral_strain.push_back(std::log(x));
  }
  return curve;
}

double axial_stress(const CellStiffness& stiffness, double x, double z, double edge) {
  return axial_stress(stiffness.springs().data(), x, z, edge);
}

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
    const double values[] = {value(k[0]), value(k[1]), value(k[2])}, z = std::exp(strain);
    double x0 = 0;
    try {
      x0 = lateral_stretch({values[0], values[1], values[2]}, z);
    } catch (const cases::SolveError&) {
      return false; // no value of the objective here, for Ceres
    }
    const Number guess(x0),
        x = guess - lateral_imbalance(k, guess, z) / lateral_imbalance_slope(values, x0, z);
    residual[0] = (axial_stress(k, x, z, edge) - stress) / stress_norm;
    residual[1] = (log(x) - lateral) / lateral_norm;
    return true;
  }

 private:
  static double value(double number) { return number; }
  template<int n>
  static double value(const ceres::Jet<double, n>& number) {
    return number.a;
  }
};

/// Springs have the size of E L0, E the secant modulus of the reference's largest strain under stress.
double stiffness_unit(const UniaxialCurve& reference, double edge) {
  double largest = 0, modulus = 0;
  for (std::size_t i = 0; i < reference.axial_strain.size(); ++i) {
    const double strain = std::abs(reference.axial_strain[i]), stress = std::abs(reference.stress[i]);
    if (!(stress > 0 && strain > largest)) continue;
    largest = strain;
    modulus = stress / strain;
  }
  return modulus * edge;
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

/// Moves three scaled stiffnesses to a minimum of the objective, which it returns if it gets there.
std::optional<double> fit_from(const UniaxialCurve& reference, double edge, double unit, double* scaled) {
  ceres::Problem problem;
  problem.AddParameterBlock(scaled, 3);
  for (std::size_t i = 0; i < reference.axial_strain.size(); ++i) {
    if (reference.axial_strain[i] == 0) continue; // a cell at rest has neither stress nor strain
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<StrainResidual, 2, 3>(
                                 new StrainResidual(residual_at(reference, i, edge, unit))),
                             nullptr, scaled);
  }
  for (int c = 0; c < 3; ++c) problem.SetParameterLowerBound(scaled, c, 0);
  ceres::Solver::Options options;
  options.max_num_iterations = 2000; // the valley is flat: hundreds of steps from a bad start
  options.function_tolerance = 1e-10;
  options.gradient_tolerance = 1e-11;
  options.parameter_tolerance = 1e-10;
  const ceres::Solver::Summary summary = minimise(problem, options);
  return summary.IsSolutionUsable() ? std::optional(2 * summary.final_cost) : std::nullopt;
}

/// Equal stiffnesses, each kind of spring dominant, and two far corners.
constexpr double starts[6][3] = {{0.2, 0.2, 0.2}, {1, 0.05, 0.05}, {0.05, 1, 0.05},
                                 {0.05, 0.05, 1}, {1, 1, 0.05},    {2, 2, 2}};

} // namespace

Eigen::VectorXd uniaxial_residuals(const CellStiffness& stiffness, double edge,
                                   const UniaxialCurve& reference, Eigen::MatrixX3d* jacobian) {
  check(reference);
  const auto n = static_cast<Eigen::Index>(reference.axial_strain.size());
  Eigen::VectorXd residuals(2 * n);
  Eigen::MatrixX3d derivatives(2 * n, 3);
  for (Eigen::Index i = 0; i < n; ++i) {
    using Jet = ceres::Jet<double, 3>;
    const Jet k[] = {Jet(stiffness.edge, 0), Jet(stiffness.face_diagonal, 1),
                     Jet(stiffness.internal_diagonal, 2)};
    Jet pair[2];
    if (!residual_at(reference, static_cast<std::size_t>(i), edge, 1)(k, pair))
      throw cases::SolveError("uniaxial test of one cell: no width is in equilibrium with these stiffnesses");
    residuals(i) = pair[0].a;
    residuals(n + i) = pair[1].a;
    derivatives.row(i) = pair[0].v;
    derivatives.row(n + i) = pair[1].v;
  }
  if (jacobian != nullptr) *jacobian = derivatives;
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
    double k[] = {start[0], start[1], start[2]};
    const std::optional<double> objective = fit_from(reference, edge, unit, k);
    if (!objective) continue;
    fit.minimisers.push_back({unit * k[0], unit * k[1], unit * k[2], 0});
    if (!(*objective < fit.objective)) continue;
    fit.objective = *objective;
    fit.stiffness = fit.minimisers.back();
  }
  if (fit.minimisers.empty())
    throw cases::SolveError("nonlinear method: the minimisation converged from no start");
  return fit;
}

Identifiability identifiability(const CellStiffness& stiffness, double edge, const UniaxialCurve& reference) {
  Eigen::MatrixX3d jacobian;
  uniaxial_residuals(stiffness, edge, reference, &jacobian);
  const mechanics::Spectrum parts = mechanics::right_singular(jacobian * stiffness_unit(reference, edge));
  const Eigen::Vector3d values = parts.values;
  return {values, parts.vectors, values(0) / values(2)};
}

} // namespace springproof::msm
