#include "msm/design/multi_load.hpp"

#include "cases/case/error.hpp"
#include "cases/case/names.hpp"
#include "mechanics/laws/log_strain.hpp"
#include "mechanics/laws/principal_stress.hpp"
#include "mechanics/laws/yeoh.hpp"
#include "msm/design/cells.hpp"
#include "msm/design/design.hpp"
#include "msm/design/minimise.hpp"
#include "msm/design/small_strain.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <ceres/dynamic_numeric_diff_cost_function.h>
#include <ceres/normal_prior.h>
#include <cmath>
#include <numeric>

namespace springproof::msm {

namespace {

using cases::LoadPath;

constexpr int n_states = 20; ///< per path, as in the thesis's uniaxial fit
constexpr int n_residuals = 9 * n_states;
using PathVector = Eigen::Matrix<double, n_residuals, 1>;
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

template<class Law>
Eigen::Matrix3d stress_of(const typename Law::Material& material, const Eigen::Matrix3d& f, int free) {
  const Eigen::Matrix3d stress =
      mechanics::cauchy_stress_without_pressure<Law>(mechanics::parameters_of(material), f);
  return stress - stress(free, free) * Eigen::Matrix3d::Identity();
}

Eigen::Matrix3d log_strain_stress(const cases::LinearElastic& material, const Eigen::Matrix3d& f) {
  const auto parameters = mechanics::parameters_of(material);
  return mechanics::cauchy_stress_without_pressure<mechanics::LogStrain>(parameters, f) +
         mechanics::LogStrain::pressure(f.determinant() - 1, parameters).value * Eigen::Matrix3d::Identity();
}

enum class Part { all, deviator };

Eigen::Matrix3d part_of(const Eigen::Matrix3d& stress, Part part) {
  if (part == Part::all) return stress;
  return stress - stress.trace() / 3 * Eigen::Matrix3d::Identity();
}

Eigen::Matrix3d cauchy_stress(const CellStiffness& stiffness, double edge, const Eigen::Matrix3d& f) {
  return lattice_stress(stiffness, edge, f) * f.transpose() / f.determinant();
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

/// Stresses of springs held against a material's over the states of several paths.
class Fit {
 public:
  /// @param name  begins messages    @param part  part of the stresses that counts
  Fit(const std::string& name, const cases::Material& material, double edge,
      const MultiLoadSettings& settings, Part part)
      : name_(name), edge_(edge), part_(part), unit_(small_strain_material(material).youngs_modulus * edge),
        to_stiffness_(unknowns_to_stiffness(settings.split, settings.has_volume_term && part == Part::all)) {
    if (settings.has_volume_term && part == Part::deviator) lambda_ = settings.incompressible_lambda;
    for (std::size_t p = 0; p < settings.paths.size(); ++p) {
      Path path{{}, 0, settings.weights[p]};
      for (int i = 0; i < n_states; ++i) {
        const double t = static_cast<double>(i) / (n_states - 1);
        const double strain = settings.lowest_strain + t * (settings.highest_strain - settings.lowest_strain);
        path.states.push_back(material_state(material, settings.paths[p], strain));
        path.size_squared += part_of(path.states.back().cauchy_stress, part).squaredNorm();
      }
      if (!(path.size_squared > 0))
        throw cases::InputError(name + ": the material has no stress on path " +
                                cases::name_of(settings.paths[p]));
      paths_.push_back(std::move(path));
    }
  }

  const std::string& name() const { return name_; }
  std::size_t n_paths() const { return paths_.size(); }
  Eigen::Index n_unknowns() const { return to_stiffness_.cols(); }

  /// Springs of unknowns over E edge.
  CellStiffness springs(const Eigen::VectorXd& unknowns, const std::optional<Exponents>& exponents) const {
    const Eigen::Vector4d k = to_stiffness_ * (unit_ * unknowns);
    return {k(0), k(1), k(2), k(3) / edge_, exponents};
  }

  /// Errors of a path's states over the norm of its stresses, times the square root of its weight.
  /// @param of_material  part of its stresses that is taken off
  PathVector residuals(std::size_t path, const CellStiffness& springs, double of_material = 1) const {
    const auto& [states, size_squared, weight] = paths_[path];
    const double scale = std::sqrt(size_squared / weight);
    PathVector all;
    double* next = all.data();
    for (const auto& [f, stress] : states) {
      const Eigen::Matrix3d error =
          part_of(cauchy_stress(springs, edge_, f) - of_material * stress, part_) / scale;
      next = std::copy(error.data(), error.data() + 9, next);
    }
    return all;
  }

  /// The unknowns over E edge at their minimum for springs of these exponents.
  Eigen::VectorXd best_unknowns(const std::optional<Exponents>& exponents) const {
    const auto n_rows = static_cast<Eigen::Index>(n_residuals * n_paths());
    Eigen::MatrixXd columns(n_rows, n_unknowns());
    Eigen::VectorXd target(n_rows);
    for (std::size_t p = 0; p < n_paths(); ++p) {
      const auto first = static_cast<Eigen::Index>(n_residuals * p);
      target.segment<n_residuals>(first) = -residuals(p, {});
      for (Eigen::Index c = 0; c < n_unknowns(); ++c)
        columns.block<n_residuals, 1>(first, c) =
            residuals(p, springs(Eigen::VectorXd::Unit(n_unknowns(), c), exponents), 0);
    }
    return nonnegative_least_squares(columns, target);
  }

  MultiLoadFit result(const Eigen::VectorXd& unknowns, const std::optional<Exponents>& exponents) const {
    MultiLoadFit fit{springs(unknowns, exponents), 0, {}};
    for (const Path& path : paths_) {
      double squares = 0;
      for (const auto& [f, stress] : path.states)
        squares += part_of(cauchy_stress(fit.stiffness, edge_, f) - stress, part_).squaredNorm();
      fit.errors.push_back(std::sqrt(squares / path.size_squared));
      fit.objective += path.weight * squares / path.size_squared;
    }
    if (lambda_) // the lattice's: C12 = C44 + k_v
      fit.stiffness.volume = *lambda_ - averaged_moduli(cell_elasticity(fit.stiffness, cube(edge_))).c44;
    return fit;
  }

 private:
  struct Path {
    std::vector<MaterialState> states;
    double size_squared, weight; ///< squared norm of the material's stresses; the path's weight
  };
  std::string name_;
  double edge_;
  Part part_;
  double unit_; ///< unit of stiffnesses, N/mm
  Eigen::MatrixXd to_stiffness_;
  std::optional<double> lambda_; ///< Lame's constant that the volume term gives the lattice, MPa
  std::vector<Path> paths_;
};

/// The residuals of a path, a function of the three exponents, and of a fit's unknowns unless stiffnesses are
/// held.
struct PowerLogError {
  const Fit& fit;
  std::size_t path;
  const std::optional<CellStiffness>& held;

  bool operator()(double const* const* parameters, double* residual) const {
    CellStiffness springs =
        held ? *held : fit.springs(Eigen::Map<const Eigen::VectorXd>(parameters[1], fit.n_unknowns()), {});
    const double* p = parameters[0];
    springs.exponents = {p[0], p[1], p[2]};
    Eigen::Map<PathVector> errors(residual);
    errors = fit.residuals(path, springs);
    return true;
  }
};

struct FittedExponents {
  Exponents exponents;
  Eigen::VectorXd unknowns; ///< solution of the fit; none where stiffnesses are held
  double objective;         ///< minimum of the fit, with the squares of exponent_prior (p - start)
};

/// @param start  one exponent for all kinds, near which they are held
/// @param lowest  exponent, if there is one    @param held  stiffnesses that stay; absent: they are fitted
/// too
FittedExponents fit_exponents(const Fit& fit, double start, const std::optional<double>& lowest,
                              const std::optional<CellStiffness>& held = {}) {
  Exponents exponents{};
  double* const p = exponents.by_kind.data();
  exponents.by_kind.fill(lowest ? std::max(start, *lowest) : start);
  Eigen::VectorXd unknowns;
  std::vector<double*> parameters{p};
  if (!held) {
    unknowns = fit.best_unknowns(exponents);
    parameters.push_back(unknowns.data());
  }
  ceres::Problem problem;
  for (std::size_t path = 0; path < fit.n_paths(); ++path) {
    auto* cost = new ceres::DynamicNumericDiffCostFunction<PowerLogError, ceres::CENTRAL>(
        new PowerLogError{fit, path, held});
    cost->AddParameterBlock(3);
    if (!held) cost->AddParameterBlock(static_cast<int>(fit.n_unknowns()));
    cost->SetNumResiduals(n_residuals);
    problem.AddResidualBlock(cost, nullptr, parameters);
  }
  problem.AddResidualBlock(
      new ceres::NormalPrior(exponent_prior * Eigen::Matrix3d::Identity(), Eigen::Vector3d::Constant(start)),
      nullptr, p);
  for (int kind = 0; lowest && kind < 3; ++kind) problem.SetParameterLowerBound(p, kind, *lowest);
  for (int i = 0; i < unknowns.size(); ++i) problem.SetParameterLowerBound(unknowns.data(), i, 0);
  ceres::Solver::Options options;
  options.function_tolerance = 1e-14;
  options.parameter_tolerance = 1e-10;
  const double objective = minimum_of(problem, options, fit.name());
  return {exponents, unknowns, objective};
}

Fit multi_load_fit(const cases::Material& material, double edge, const MultiLoadSettings& settings) {
  check(settings);
  const bool holds_volume = settings.has_volume_term && cases::is_hyperelastic(material);
  return {"multi-load design", material, edge, settings, holds_volume ? Part::deviator : Part::all};
}

} // namespace

MaterialState material_state(const cases::Material& material, LoadPath path, double strain) {
  if (cases::is_hyperelastic(material)) {
    const Eigen::Matrix3d f = deformation(path, strain, 0.5);
    const auto* yeoh = std::get_if<cases::Yeoh>(&material);
    return {f, yeoh ? stress_of<mechanics::Yeoh>(*yeoh, f, free_axis(path))
                    : stress_of<mechanics::Ogden>(std::get<cases::Ogden>(material), f, free_axis(path))};
  }
  const auto& linear = std::get<cases::LinearElastic>(material);
  if (!(linear.youngs_modulus > 0) || !(linear.poissons_ratio > -1 && linear.poissons_ratio < 0.5))
    throw cases::InputError("multi-load design: needs E > 0 and -1 < nu < 0.5");
  const Eigen::Matrix3d f = deformation(path, strain, linear.poissons_ratio);
  return {f, log_strain_stress(linear, f)};
}

MultiLoadFit multi_load_method(const cases::Material& material, double edge,
                               const MultiLoadSettings& settings) {
  const Fit fit = multi_load_fit(material, edge, settings);
  return fit.result(fit.best_unknowns(settings.exponents), settings.exponents);
}

MultiLoadFit multi_load_with_exponents(const cases::Material& material, double edge,
                                       const MultiLoadSettings& settings, double exponent) {
  const Fit fit = multi_load_fit(material, edge, settings);
  const bool is_hyperelastic = cases::is_hyperelastic(material);
  const FittedExponents found =
      fit_exponents(fit, exponent, is_hyperelastic ? lowest_ogden_exponent : lowest_exponent);
  const MultiLoadFit fitted = fit.result(found.unknowns, found.exponents);
  const auto is_stable = [&](const MultiLoadFit& of) {
    return is_stable_over({settings.lowest_strain, settings.highest_strain}, of.stiffness, edge);
  };
  const auto towards_hooke = [&](double part) {
    Exponents p = *fitted.stiffness.exponents;
    for (double& of : p.by_kind) of += part * (hookean_exponent - of);
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

double second_order_coefficient(const cases::Material& material, double poissons_ratio) {
  const double nu = poissons_ratio;
  if (!cases::is_hyperelastic(material)) return -(0.5 + 2 * nu);
  double mean_alpha = 2; // Yeoh's: powers of I - 3 from the second on are of fourth order and more
  if (const auto* ogden = std::get_if<cases::Ogden>(&material))
    mean_alpha = std::inner_product(ogden->mu.begin(), ogden->mu.end(), ogden->alpha.begin(), 0.) /
                 cases::at_rest(*ogden).shear_modulus;
  return -1.5 + mean_alpha * (1 + nu) * (1 + nu) / 9 + (1 - 2 * nu) * (1 - 2 * nu) / 3;
}

double closed_form_exponent(double second_order_coefficient, const mechanics::ElasticModuli& moduli,
                            double split) {
  const auto& [lambda, mu, kappa] = moduli;
  const double t = split, nu = lambda / (2 * (lambda + mu)), sum = 1 + nu, volume = 1 - 2 * nu;
  // Logarithmic strain of the diagonals per axial strain, to first order; an edge has 1 or -nu.
  const double face = (1 - nu) / 2, internal = volume / 3;
  // Over mu, terms with p + 1 and without: docs/developing/design-theory.md.
  const double with = (1 + t) * (1 - 2 * std::pow(nu, 3)) +
                      2 * (1 - t) * (4 * std::pow(face, 3) - 2 * std::pow(nu, 3)) +
                      9 * t * std::pow(internal, 3);
  const double without =
      6 * (1 - t) * face * sum * sum + 6 * t * internal * sum * sum + (lambda / mu - 1) * std::pow(volume, 3);
  return ((second_order_coefficient + 1.5) * 2 * sum - without) / with - 1;
}

MatchedFit matched_exponents(const cases::Material& material, const mechanics::ElasticModuli& moduli,
                             double split, const std::array<double, 2>& strain_range) {
  const double nu = moduli.lambda / (2 * (moduli.lambda + moduli.mu));
  const double start = closed_form_exponent(second_order_coefficient(material, nu), moduli, split);
  const CellStiffness springs = hybrid_method(moduli.lambda, moduli.mu, split, cube(1));
  const MultiLoadSettings settings{
      {LoadPath::uniaxial, LoadPath::pure_shear}, {0.5, 0.5}, strain_range[0], strain_range[1], false, 0};
  const Fit fit("matched design", material, 1, settings, Part::deviator);
  const bool is_hyperelastic = cases::is_hyperelastic(material);
  const FittedExponents found = fit_exponents(
      fit, start, is_hyperelastic ? std::optional(lowest_ogden_exponent) : std::nullopt, springs);
  return {found.exponents, found.objective};
}

} // namespace springproof::msm
