#include "msm/design/multi_load.hpp"

#include "cases/case/error.hpp"
#include "cases/case/names.hpp"
#include "mechanics/laws/log_strain.hpp"
#include "mechanics/laws/ogden.hpp"
#include "mechanics/laws/principal_stress.hpp"
#include "msm/design/bounded_least_squares.hpp"
#include "msm/design/design.hpp"
#include "msm/design/exponents.hpp"
#include "msm/design/homogeneous.hpp"
#include "msm/design/minimise.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <ceres/dynamic_numeric_diff_cost_function.h>
#include <cmath>

namespace springproof::msm {

namespace {

using cases::LoadPath;
using Vector6 = Eigen::Matrix<double, 6, 1>;

constexpr int n_states = 20;             ///< per path, as in the thesis's uniaxial fit
constexpr double lowest_exponent = -20;  ///< as in case files
constexpr double hookean_exponent = 0.5; ///< whose tension has no second-order part, as Hooke's

Eigen::Matrix3d deformation(LoadPath path, double strain, double nu) {
  if (path == LoadPath::simple_shear) return simple_shear(strain);
  const double free_of_two =
      -nu / (1 - nu); // strain of the one free direction for a unit sum of the other two
  Eigen::Vector3d e(strain, 0, free_of_two * strain); // pure shear
  if (path == LoadPath::uniaxial) e = {-nu * strain, -nu * strain, strain};
  if (path == LoadPath::equibiaxial) e = {strain, strain, 2 * free_of_two * strain};
  return e.array().exp().matrix().asDiagonal();
}

/// The direction in which the path leaves the material free.
int free_axis(LoadPath path) {
  return path == LoadPath::uniaxial ? 0 : path == LoadPath::simple_shear ? 1 : 2;
}

Eigen::Matrix3d ogden_stress(const cases::Ogden& ogden, const Eigen::Matrix3d& f, int free) {
  const Eigen::Matrix3d stress =
      mechanics::cauchy_stress_without_pressure<mechanics::Ogden>(mechanics::parameters_of(ogden), f);
  return stress - stress(free, free) * Eigen::Matrix3d::Identity();
}

Eigen::Matrix3d log_strain_stress(const cases::LinearElastic& material, const Eigen::Matrix3d& f) {
  const auto parameters = mechanics::parameters_of(material);
  return mechanics::cauchy_stress_without_pressure<mechanics::LogStrain>(parameters, f) +
         mechanics::LogStrain::pressure(f.determinant() - 1, parameters).value * Eigen::Matrix3d::Identity();
}

enum class Part { all, deviator };

/// Components weighted so that the squared norm is that of the tensor.
Vector6 part_of(const Eigen::Matrix3d& stress, Part part) {
  Eigen::Matrix3d s = stress;
  if (part == Part::deviator) s -= stress.trace() / 3 * Eigen::Matrix3d::Identity();
  const double root = std::sqrt(2.0);
  Vector6 v;
  v << s(0, 0), s(1, 1), s(2, 2), root * s(0, 1), root * s(1, 2), root * s(0, 2);
  return v;
}

Eigen::Matrix3d cauchy_stress(const CellStiffness& stiffness, double edge, const Eigen::Matrix3d& f) {
  return lattice_stress(stiffness, edge, f) * f.transpose() / f.determinant();
}

/// Residual of one path = matrix * k - target; k = (k_e, k_f, k_d, k_v edge), N/mm.
struct LinearProblem {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd target;
};

LinearProblem path_problem(const cases::Material& material, double edge, LoadPath path, Part part,
                           const MultiLoadSettings& settings, const std::optional<Exponents>& exponents) {
  LinearProblem problem{Eigen::MatrixXd(6 * n_states, 4), Eigen::VectorXd(6 * n_states)};
  std::array<CellStiffness, 4> units = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1 / edge}}};
  for (CellStiffness& unit : units) unit.exponents = exponents;
  for (int i = 0; i < n_states; ++i) {
    const double t = static_cast<double>(i) / (n_states - 1);
    const double strain = settings.lowest_strain + t * (settings.highest_strain - settings.lowest_strain);
    const MaterialState state = material_state(material, path, strain);
    problem.target.segment<6>(6 * i) = part_of(state.cauchy_stress, part);
    for (int c = 0; c < 4; ++c)
      problem.matrix.block<6, 1>(6 * i, c) =
          part_of(cauchy_stress(units[static_cast<std::size_t>(c)], edge, state.deformation_gradient), part);
  }
  const double norm = problem.target.norm();
  if (!(norm > 0))
    throw cases::InputError("multi-load design: the material has no stress on path " + cases::name_of(path));
  problem.matrix /= norm;
  problem.target /= norm;
  return problem;
}

/// Columns k = T x of the stiffnesses in terms of the unknowns. With a split t these are k_e, the shear
/// stiffness m = K_f + 4 K_d/3 of the lattice [and k_v edge]; without, the stiffnesses themselves.
Eigen::MatrixXd unknowns_to_stiffness(const std::optional<double>& split, bool fits_volume) {
  Eigen::Matrix4d columns = Eigen::Matrix4d::Identity();
  if (split) {
    columns.col(1) << 0, (1 - *split) / 2, 0.75 * *split, 0;
    columns.col(2) = Eigen::Vector4d::UnitW();
  }
  return columns.leftCols((split ? 2 : 3) + (fits_volume ? 1 : 0));
}

void check(const MultiLoadSettings& settings) {
  double sum = 0;
  for (const double weight : settings.weights) sum += weight >= 0 ? weight : std::nan("");
  if (settings.paths.empty() || settings.weights.size() != settings.paths.size() || !(sum > 0))
    throw cases::InputError(
        "multi-load design: needs paths, and as many weights, none negative and not all 0");
  if (!(settings.highest_strain > settings.lowest_strain))
    throw cases::InputError(
        "multi-load design: the strain range must have its upper end above its lower one");
  if (settings.split && !(*settings.split >= 0 && *settings.split <= 1))
    throw cases::InputError("multi-load design: split must lie in [0, 1]");
}

/// The fit of all paths at once.
class Fit {
 public:
  Fit(const cases::Material& material, double edge, const MultiLoadSettings& settings)
      : material_(material), edge_(edge), settings_(settings),
        is_incompressible_(std::holds_alternative<cases::Ogden>(material)),
        part_(settings.has_volume_term && is_incompressible_ ? Part::deviator : Part::all),
        unit_(small_strain_material(material).youngs_modulus * edge),
        to_stiffness_(
            unknowns_to_stiffness(settings.split, settings.has_volume_term && !is_incompressible_)) {}

  Eigen::Index n_residuals() const {
    return static_cast<Eigen::Index>(6 * n_states * settings_.paths.size());
  }
  Eigen::Index n_unknowns() const { return to_stiffness_.cols(); }

  /// All paths below each other, each with the square root of its weight.
  LinearProblem weighted(const std::optional<Exponents>& exponents) const {
    LinearProblem all{Eigen::MatrixXd(n_residuals(), 4), Eigen::VectorXd(n_residuals())};
    for (std::size_t p = 0; p < settings_.paths.size(); ++p) {
      const auto first = static_cast<Eigen::Index>(6 * n_states * p);
      const double factor = std::sqrt(settings_.weights[p]);
      const LinearProblem problem = problem_of(p, exponents);
      all.matrix.middleRows<6 * n_states>(first) = factor * problem.matrix;
      all.target.segment<6 * n_states>(first) = factor * problem.target;
    }
    return all;
  }

  /// The unknowns over E edge, at their minimum for springs of these exponents.
  Eigen::VectorXd best_unknowns(const std::optional<Exponents>& exponents) const {
    const LinearProblem all = weighted(exponents);
    return bounded_least_squares(all.matrix * to_stiffness_, all.target, unit_) / unit_;
  }

  Eigen::VectorXd stiffness_of(const Eigen::VectorXd& unknowns) const {
    return to_stiffness_ * (unit_ * unknowns);
  }

  MultiLoadFit result(const Eigen::VectorXd& unknowns, const std::optional<Exponents>& exponents) const {
    const Eigen::VectorXd k = stiffness_of(unknowns);
    MultiLoadFit fit{{k(0), k(1), k(2), k(3) / edge_, exponents}, 0, {}};
    for (std::size_t p = 0; p < settings_.paths.size(); ++p) {
      const LinearProblem problem = problem_of(p, exponents);
      fit.errors.push_back((problem.matrix * k - problem.target).norm());
      fit.objective += settings_.weights[p] * fit.errors[p] * fit.errors[p];
    }
    // Lambda of the lattice is C12 = C44 + k_v.
    if (part_ == Part::deviator)
      fit.stiffness.volume = settings_.incompressible_lambda - lattice_moduli(fit.stiffness, edge_).c44;
    return fit;
  }

 private:
  LinearProblem problem_of(std::size_t path, const std::optional<Exponents>& exponents) const {
    return path_problem(material_, edge_, settings_.paths[path], part_, settings_, exponents);
  }

  const cases::Material& material_;
  double edge_;
  const MultiLoadSettings& settings_;
  bool is_incompressible_;
  Part part_;
  double unit_; ///< N/mm
  Eigen::MatrixXd to_stiffness_;
};

Exponents exponents_of(const double* p) {
  return {p[0], p[1], p[2]};
}

/// The weighted residual, a function of the unknowns and of the three exponents.
struct PowerLogError {
  const Fit& fit;

  bool operator()(double const* const* parameters, double* residual) const {
    const LinearProblem all = fit.weighted(exponents_of(parameters[1]));
    const Eigen::Map<const Eigen::VectorXd> unknowns(parameters[0], fit.n_unknowns());
    Eigen::Map<Eigen::VectorXd>(residual, fit.n_residuals()) =
        all.matrix * fit.stiffness_of(unknowns) - all.target;
    return true;
  }
};

/// @param start  one exponent for all kinds, near which they are held    @param lowest  exponent
MultiLoadFit fit_exponents(const Fit& fit, double start, double lowest) {
  std::array<double, 3> p;
  p.fill(std::max(start, lowest));
  Eigen::VectorXd unknowns = fit.best_unknowns(exponents_of(p.data()));
  auto* cost =
      new ceres::DynamicNumericDiffCostFunction<PowerLogError, ceres::CENTRAL>(new PowerLogError{fit});
  cost->AddParameterBlock(static_cast<int>(fit.n_unknowns()));
  cost->AddParameterBlock(3);
  cost->SetNumResiduals(static_cast<int>(fit.n_residuals()));
  ceres::Problem problem;
  problem.AddResidualBlock(cost, nullptr, unknowns.data(), p.data());
  for (int i = 0; i < fit.n_unknowns(); ++i) problem.SetParameterLowerBound(unknowns.data(), i, 0);
  minimum_over_exponents(problem, p, start, lowest, "multi-load design");
  return fit.result(unknowns, exponents_of(p.data()));
}

} // namespace

MaterialState material_state(const cases::Material& material, LoadPath path, double strain) {
  if (const auto* ogden = std::get_if<cases::Ogden>(&material)) {
    const Eigen::Matrix3d f = deformation(path, strain, 0.5);
    return {f, ogden_stress(*ogden, f, free_axis(path))};
  }
  const auto& linear = std::get<cases::LinearElastic>(material);
  if (!(linear.youngs_modulus > 0) || !(linear.poissons_ratio > -1 && linear.poissons_ratio < 0.5))
    throw cases::InputError("multi-load design: needs E > 0 and -1 < nu < 0.5");
  const Eigen::Matrix3d f = deformation(path, strain, linear.poissons_ratio);
  return {f, log_strain_stress(linear, f)};
}

MultiLoadFit multi_load_method(const cases::Material& material, double edge,
                               const MultiLoadSettings& settings) {
  check(settings);
  const Fit fit(material, edge, settings);
  return fit.result(fit.best_unknowns(settings.exponents), settings.exponents);
}

MultiLoadFit multi_load_with_exponents(const cases::Material& material, double edge,
                                       const MultiLoadSettings& settings, double exponent) {
  check(settings);
  const Fit fit(material, edge, settings);
  const bool is_ogden = std::holds_alternative<cases::Ogden>(material);
  const MultiLoadFit fitted =
      fit_exponents(fit, exponent, is_ogden ? lowest_ogden_exponent : lowest_exponent);
  const auto is_stable = [&](const MultiLoadFit& found) {
    return is_stable_over({settings.lowest_strain, settings.highest_strain}, found.stiffness, edge);
  };
  const auto towards_hooke = [&](double part) {
    Exponents p = *fitted.stiffness.exponents;
    for (double* of : {&p.edge, &p.face_diagonal, &p.internal_diagonal})
      *of += part * (hookean_exponent - *of);
    return fit.result(fit.best_unknowns(p), p);
  };
  if (is_stable(fitted) || !is_stable(towards_hooke(1))) return fitted;
  double unstable = 0, stable = 1;
  while (stable - unstable > 1e-3) {
    const double middle = (stable + unstable) / 2;
    (is_stable(towards_hooke(middle)) ? stable : unstable) = middle;
  }
  return towards_hooke(stable);
}

} // namespace springproof::msm
