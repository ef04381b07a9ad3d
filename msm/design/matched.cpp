#include "msm/design/matched.hpp"

#include "cases/case/error.hpp"
#include "msm/design/homogeneous.hpp"
#include "msm/design/minimise.hpp"
#include "msm/design/moduli_method.hpp"
#include "msm/design/multi_load.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace springproof::msm {

namespace {

constexpr int n_matched_states = 20; // per path, as in the other fits
constexpr std::array<cases::LoadPath, 2> matched_paths = {cases::LoadPath::uniaxial,
                                                          cases::LoadPath::pure_shear};

Eigen::Matrix3d deviator(const Eigen::Matrix3d& stress) {
  return stress - stress.trace() / 3 * Eigen::Matrix3d::Identity();
}

/// Relative error of the lattice's deviator along one path, a function of the three exponents.
class PathError {
 public:
  PathError(const cases::Material& material, cases::LoadPath path, const CellStiffness& springs,
            const std::array<double, 2>& strain_range)
      : springs_(springs) {
    double squares = 0;
    for (int i = 0; i < n_matched_states; ++i) {
      const double part = static_cast<double>(i) / (n_matched_states - 1);
      states_.push_back(
          material_state(material, path, strain_range[0] + part * (strain_range[1] - strain_range[0])));
      squares += deviator(states_.back().cauchy_stress).squaredNorm();
    }
    if (!(squares > 0))
      throw cases::InputError("matched design: the material has no stress on path " + cases::name_of(path));
    norm_ = std::sqrt(squares * matched_paths.size());
  }

  bool operator()(const double* p, double* residual) const {
    CellStiffness springs = springs_;
    springs.exponents = Exponents{p[0], p[1], p[2]};
    for (const auto& [f, stress] : states_) {
      const Eigen::Matrix3d of_lattice = lattice_stress(springs, 1, f) * f.transpose() / f.determinant();
      const Eigen::Matrix3d error = deviator(of_lattice - stress) / norm_;
      residual = std::copy(error.data(), error.data() + 9, residual);
    }
    return true;
  }

 private:
  CellStiffness springs_; ///< of a cell of edge 1
  std::vector<MaterialState> states_;
  double norm_ = 0;
};

} // namespace

MatchedFit matched_exponents(const cases::Material& material, const mechanics::ElasticModuli& moduli,
                             double split, const std::array<double, 2>& strain_range) {
  const double nu = moduli.lambda / (2 * (moduli.lambda + moduli.mu));
  const double start = closed_form_exponent(second_order_coefficient(material, nu), moduli, split);
  const CellStiffness springs = hybrid_method(moduli.lambda, moduli.mu, split, cube(1));
  const bool is_ogden = std::holds_alternative<cases::Ogden>(material);
  const double bounded = is_ogden ? std::max(start, lowest_ogden_exponent) : start;
  std::array<double, 3> p = {bounded, bounded, bounded};
  ceres::Problem problem;
  for (const cases::LoadPath path : matched_paths)
    problem.AddResidualBlock(
        new ceres::NumericDiffCostFunction<PathError, ceres::CENTRAL, 9 * n_matched_states, 3>(
            new PathError(material, path, springs, strain_range)),
        nullptr, p.data());
  const double objective = minimum_over_exponents(
      problem, p, start, is_ogden ? std::optional(lowest_ogden_exponent) : std::nullopt, "matched design");
  return {{p[0], p[1], p[2]}, objective};
}

} // namespace springproof::msm
