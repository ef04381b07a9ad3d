#include "msm/design/multi_load.hpp"

#include "cases/case/error.hpp"
#include "cases/case/names.hpp"
#include "mechanics/laws/log_strain.hpp"
#include "mechanics/laws/ogden.hpp"
#include "msm/design/bounded_least_squares.hpp"
#include "msm/design/design.hpp"
#include "msm/design/homogeneous.hpp"

#include <Eigen/LU>
#include <cmath>

namespace springproof::msm {

namespace {

using cases::LoadPath;
using Vector6 = Eigen::Matrix<double, 6, 1>;

constexpr int n_states = 20; ///< per path, as in the thesis's uniaxial fit

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
  const Eigen::Matrix3d stress = mechanics::cauchy_stress_without_pressure(mechanics::Ogden(ogden), f);
  return stress - stress(free, free) * Eigen::Matrix3d::Identity();
}

Eigen::Matrix3d log_strain_stress(const cases::LinearElastic& material, const Eigen::Matrix3d& f) {
  const mechanics::LogStrain law(material);
  return mechanics::cauchy_stress_without_pressure(law, f) +
         law.pressure(f.determinant()).value * Eigen::Matrix3d::Identity();
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
                           const MultiLoadSettings& settings) {
  LinearProblem problem{Eigen::MatrixXd(6 * n_states, 4), Eigen::VectorXd(6 * n_states)};
  const std::array<CellStiffness, 4> units = {
      {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1 / edge}}};
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
  const bool is_incompressible = std::holds_alternative<cases::Ogden>(material);
  const bool fits_volume = settings.has_volume_term && !is_incompressible;
  const Part part = settings.has_volume_term && is_incompressible ? Part::deviator : Part::all;
  // All paths below each other, each with the square root of its weight.
  const auto rows = static_cast<Eigen::Index>(6 * n_states * settings.paths.size());
  LinearProblem all{Eigen::MatrixXd(rows, 4), Eigen::VectorXd(rows)};
  std::vector<LinearProblem> problems;
  for (const LoadPath path : settings.paths) {
    const auto first = static_cast<Eigen::Index>(6 * n_states * problems.size());
    const double factor = std::sqrt(settings.weights[problems.size()]);
    problems.push_back(path_problem(material, edge, path, part, settings));
    all.matrix.middleRows<6 * n_states>(first) = factor * problems.back().matrix;
    all.target.segment<6 * n_states>(first) = factor * problems.back().target;
  }
  const double unit = small_strain_material(material).youngs_modulus * edge;
  const Eigen::MatrixXd to_stiffness = unknowns_to_stiffness(settings.split, fits_volume);
  const Eigen::VectorXd k = to_stiffness * bounded_least_squares(all.matrix * to_stiffness, all.target, unit);
  MultiLoadFit fit{{k(0), k(1), k(2), k(3) / edge}, 0, {}};
  for (std::size_t p = 0; p < problems.size(); ++p) {
    fit.errors.push_back((problems[p].matrix * k - problems[p].target).norm());
    fit.objective += settings.weights[p] * fit.errors[p] * fit.errors[p];
  }
  // Lambda of the lattice is C12 = C44 + k_v.
  if (part == Part::deviator)
    fit.stiffness.volume = settings.incompressible_lambda - lattice_moduli(fit.stiffness, edge).c44;
  return fit;
}

} // namespace springproof::msm
