#include "msm/design/misfit.hpp"

#include "cases/case/error.hpp"
#include "mechanics/elastic_moduli.hpp"
#include "mechanics/larger.hpp"
#include "msm/design/design.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace springproof::msm {

namespace {

/// By axis: E along x, y, z, G between them (yz, xz, xy), nu as the strain along the second axis where the
/// first is stretched: xy, xz, yx, yz, zx, zy.
struct Constants {
  std::array<double, 3> youngs_modulus, shear_modulus;
  std::array<double, 6> poissons_ratio;
};

Constants constants_of(const Elasticity& elasticity) {
  const Elasticity compliance = elasticity.inverse();
  Constants found{};
  std::size_t n = 0;
  for (int i = 0; i < 3; ++i) {
    found.youngs_modulus[static_cast<std::size_t>(i)] = 1 / compliance(i, i);
    found.shear_modulus[static_cast<std::size_t>(i)] = 1 / compliance(3 + i, 3 + i);
    for (int j = 0; j < 3; ++j)
      if (j != i) found.poissons_ratio[n++] = -compliance(j, i) / compliance(i, i);
  }
  return found;
}

/// One number where they all print alike.
template<std::size_t n>
std::string numbers_text(const std::array<double, n>& values) {
  std::vector<std::string> texts;
  for (const double value : values)
    texts.push_back(fmt::format("{:.3g}", std::abs(value) < 5e-4 ? 0. : value));
  const bool are_alike =
      std::all_of(texts.begin(), texts.end(), [&](const auto& t) { return t == texts[0]; });
  return are_alike ? texts[0] : fmt::format("({})", fmt::join(texts, ", "));
}

std::string constants_text(const Constants& c) {
  return fmt::format("E {} MPa, nu {}, G {} MPa", numbers_text(c.youngs_modulus),
                     numbers_text(c.poissons_ratio), numbers_text(c.shear_modulus));
}

} // namespace

ModuliMisfit moduli_misfit(const Elasticity& lattice, const Elasticity& material) {
  const Constants wanted = constants_of(material);
  const Eigen::SelfAdjointEigenSolver<Elasticity> solver(lattice, Eigen::EigenvaluesOnly);
  const double least = solver.eigenvalues().minCoeff(), most = solver.eigenvalues().maxCoeff();
  if (!(least > 1e-9 * most))
    return {std::numeric_limits<double>::infinity(),
            fmt::format("some strain of the lattice at rest costs no energy, where the material has {}",
                        constants_text(wanted))};
  const Constants found = constants_of(lattice);
  double largest = 0;
  for (std::size_t i = 0; i < 3; ++i)
    for (const auto& [of, as] : {std::pair(found.youngs_modulus[i], wanted.youngs_modulus[i]),
                                 {found.shear_modulus[i], wanted.shear_modulus[i]}})
      largest = mechanics::larger(largest, std::abs(of / as - 1));
  for (std::size_t i = 0; i < 6; ++i)
    largest = mechanics::larger(largest, std::abs(found.poissons_ratio[i] - wanted.poissons_ratio[i]));
  return {largest,
          fmt::format("the lattice's moduli are not the material's: {} along its axes, where the material "
                      "has {}",
                      constants_text(found), constants_text(wanted))};
}

cases::LinearElastic small_strain_material(const cases::Material& material) {
  if (const auto* linear = std::get_if<cases::LinearElastic>(&material)) return *linear;
  if (std::holds_alternative<cases::TransverselyIsotropic>(material))
    throw cases::InputError(
        "material.model: is \"transversely_isotropic\", and an isotropic material is wanted here");
  const auto& ogden = std::get<cases::Ogden>(material);
  const double mu = mechanics::shear_modulus(ogden);
  if (!ogden.bulk_modulus) return {3 * mu, 0.5};
  return mechanics::linear_elastic(mu, *ogden.bulk_modulus);
}

std::optional<Elasticity> elasticity_at_rest(const cases::Material& material) {
  Elasticity c = Elasticity::Zero();
  if (const auto* fibrous = std::get_if<cases::TransverselyIsotropic>(&material)) {
    const auto axis = cases::axis_along(fibrous->fibre);
    if (!axis) return std::nullopt;
    const mechanics::TransverseModuli m = mechanics::transverse_moduli(*fibrous);
    const int fibre = static_cast<int>(*axis);
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) c(i, j) = i == fibre || j == fibre ? m.c13 : m.c12;
      c(i, i) = i == fibre ? m.c33 : m.c11;
      c(3 + i, 3 + i) = i == fibre ? m.c66 : m.c44;
    }
    return c;
  }
  cases::LinearElastic linear = small_strain_material(material);
  if (!(linear.youngs_modulus > 0)) return std::nullopt;
  // Incompressible is a Poisson's ratio of 0.5 but for what no constant of the comparison shows.
  linear.poissons_ratio = std::min(linear.poissons_ratio, 0.5 - 1e-6);
  const mechanics::ElasticModuli moduli = mechanics::elastic_moduli(linear);
  c.topLeftCorner<3, 3>().setConstant(moduli.lambda);
  c.diagonal() << Eigen::Vector3d::Constant(moduli.lambda + 2 * moduli.mu),
      Eigen::Vector3d::Constant(moduli.mu);
  return c;
}

} // namespace springproof::msm
