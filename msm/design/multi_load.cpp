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

/// Stretches along the axes of every path but simple shear. An incompressible material has nu = 1/2.
Eigen::Matrix3d stretches(LoadPath path, double strain, double nu) {
  const double free_of_two =
      -nu / (1 - nu); // strain of the one free direction for a unit sum of the other two
  const Eigen::Vector3d e = path == LoadPath::uniaxial ? Eigen::Vector3d(-nu * strain, -nu * strain, strain)
                            : path == LoadPath::equibiaxial
                                ? Eigen::Vector3d(strain, strain, 2 * free_of_two * strain)
                                : Eigen::Vector3d(strain, 0, free_of_two * strain);
  return e.array().exp().matrix().asDiagonal();
}

Eigen::Matrix3d deformation(LoadPath path, double strain, double nu) {
  if (path != LoadPath::simple_shear) return stretches(path, strain, nu);
  Eigen::Matrix3d f = Eigen::Matrix3d::Identity();
  f(0, 2) = strain;
  return f;
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

/// Components weighted so that the squared norm is that of the tensor.
Vector6 components(const Eigen::Matrix3d& s) {
  const double root = std::sqrt(2.0);
  Vector6 v;
  v << s(0, 0), s(1, 1), s(2, 2), root * s(0, 1), root * s(1, 2), root * s(0, 2);
  return v;
}

enum class Part { all, deviator };

Vector6 part_of(const Eigen::Matrix3d& stress, Part part) {
  if (part == Part::all) return components(stress);
  return components(stress - stress.trace() / 3 * Eigen::Matrix3d::Identity());
}

Eigen::Matrix3d cauchy_stress(const CellStiffness& stiffness, double edge, const Eigen::Matrix3d& f) {
  return lattice_stress(stiffness, edge, f) * f.transpose() / f.determinant();
}

/// Weighted residual = matrix * k - target, rows of one path after the other; k = (k_e, k_f, k_d[, k_v
/// edge]), N/mm.
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
  const Eigen::MatrixXd all = Eigen::MatrixXd::Identity(4, fits_volume ? 4 : 3);
  if (!split) return all;
  Eigen::MatrixXd shared = Eigen::MatrixXd::Zero(4, fits_volume ? 3 : 2);
  shared(0, 0) = 1;
  shared(1, 1) = (1 - *split) / 2;
  shared(2, 1) = 0.75 * *split;
  if (fits_volume) shared(3, 2) = 1;
  return shared;
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

/// All paths below each other, each with the square root of its weight.
LinearProblem stack(const std::vector<LinearProblem>& problems, const std::vector<double>& weights) {
  const Eigen::Index rows = problems.front().target.size(), n = static_cast<Eigen::Index>(problems.size());
  LinearProblem all{Eigen::MatrixXd(n * rows, problems.front().matrix.cols()), Eigen::VectorXd(n * rows)};
  for (Eigen::Index p = 0; p < n; ++p) {
    const double factor = std::sqrt(weights[static_cast<std::size_t>(p)]);
    all.matrix.middleRows(p * rows, rows) = factor * problems[static_cast<std::size_t>(p)].matrix;
    all.target.segment(p * rows, rows) = factor * problems[static_cast<std::size_t>(p)].target;
  }
  return all;
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
  std::vector<LinearProblem> problems;
  for (const LoadPath path : settings.paths)
    problems.push_back(path_problem(material, edge, path, part, settings));
  const double unit = small_strain_material(material).youngs_modulus * edge;
  const LinearProblem all = stack(problems, settings.weights);
  const Eigen::MatrixXd to_stiffness = unknowns_to_stiffness(settings.split, fits_volume);
  const Eigen::VectorXd k = to_stiffness * bounded_least_squares(all.matrix * to_stiffness, all.target, unit);
  MultiLoadFit fit{{k(0), k(1), k(2), k(3) / edge}, 0, {}};
  for (std::size_t p = 0; p < problems.size(); ++p) {
    const double error = (problems[p].matrix * k - problems[p].target).norm();
    fit.objective += settings.weights[p] * error * error;
    fit.paths.push_back({settings.paths[p], settings.weights[p], error});
  }
  // Lambda of the lattice is C12 = C44 + k_v.
  if (part == Part::deviator)
    fit.stiffness.volume = settings.incompressible_lambda - lattice_moduli(fit.stiffness, edge).c44;
  return fit;
}

} // namespace springproof::msm
