#include "msm/design/exponents.hpp"

#include "mechanics/elastic_moduli.hpp"

#include <cmath>
#include <numeric>

namespace springproof::msm {

double second_order_coefficient(const cases::Material& material, double poissons_ratio) {
  const double nu = poissons_ratio;
  const auto* ogden = std::get_if<cases::Ogden>(&material);
  if (ogden == nullptr) return -(0.5 + 2 * nu);
  const double mean_alpha = std::inner_product(ogden->mu.begin(), ogden->mu.end(), ogden->alpha.begin(), 0.) /
                            mechanics::shear_modulus(*ogden);
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

} // namespace springproof::msm
