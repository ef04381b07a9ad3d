#include "msm/design/request.hpp"

#include "cases/case/error.hpp"
#include "msm/design/small_strain.hpp"

#include <cmath>
#include <fmt/format.h>

namespace springproof::msm {

namespace {

/// The share of the shear stiffness that the internal diagonals carry when the case does not say.
/// Small-strain accuracy in torsion asks for much of it (0.8); but the lattice loses its stability the
/// sooner, the more they carry: with 0.8 at a stretch of about 1.4, with 0.5 at 2.7. So a material for large
/// strains gets less.
constexpr double small_strain_split = 0.8;
constexpr double large_strain_split = 0.5;

/// lambda/mu of the volume term for an incompressible material: volumes hold to about 0.1 %, and Newton's
/// method still converges in few steps.
constexpr double incompressible_lambda_over_mu = 200;

} // namespace

void refuse(const DesignRequest& request, const std::string& problem) {
  throw cases::InputError(request.options.where, problem);
}

cases::LinearElastic designed_material(const DesignRequest& request, double lowest_poissons_ratio) {
  cases::LinearElastic material = small_strain_material(request.material);
  const cases::Msm& options = request.options;
  if (options.poissons_ratio) material.poissons_ratio = *options.poissons_ratio;
  if (!(material.youngs_modulus > 0) || !std::isfinite(material.youngs_modulus))
    refuse(request,
           fmt::format("Young's modulus {:f} MPa: must be positive and finite", material.youngs_modulus));
  if (!(material.poissons_ratio >= lowest_poissons_ratio && material.poissons_ratio < 0.5))
    refuse(request, fmt::format("Poisson's ratio {:f}: design = \"{}\" takes {:f} <= nu < 0.5; "
                                "msm.poissons_ratio (of `design`: --poisson) designs from another one",
                                material.poissons_ratio, name_of(options.design), lowest_poissons_ratio));
  return material;
}

double required_cube_edge(const DesignRequest& request) {
  const double edge = cube_edge(request.cell);
  if (edge > 0) return edge;
  refuse(request, fmt::format("design = \"{}\" is for cubical cells aligned with the axes",
                              name_of(request.options.design)));
}

LawKind law_kind(const DesignRequest& request) {
  return cases::law_of(request.options, request.material);
}

bool finds_exponents(const DesignRequest& request) {
  using Law = cases::DesignLaw;
  const Law law = cases::facts_of(request.options.design).law;
  return law_kind(request) == LawKind::power_log && (law == Law::power_log || law == Law::fitted_or_hooke ||
                                                     (law == Law::fitted && !request.options.exponent));
}

std::optional<Exponents> law_of(const DesignRequest& request) {
  const LawKind law = law_kind(request);
#pragma GCC diagnostic error "-Wswitch" // a law that is forgotten here must not compile
  switch (law) {
  case LawKind::hooke:
    return std::nullopt;
  case LawKind::power_log:
    break;
  }
  if (!request.options.exponent) return std::nullopt;
  return Exponents{*request.options.exponent, law};
}

double split(const DesignRequest& request) {
  const bool keeps_its_curve = finds_exponents(request);
  const double t = request.options.split.value_or(
      keeps_its_curve ? small_strain_split : by_material(request, large_strain_split, small_strain_split));
  if (t >= 0 && t <= 1) return t;
  refuse(request, fmt::format("split = {:f}: must lie in [0, 1]", t));
}

bool is_incompressible(const DesignRequest& request) {
  const auto rest = cases::hyperelastic_rest(request.material);
  return rest && !rest->bulk_modulus && !request.options.poissons_ratio;
}

mechanics::ElasticModuli elastic_moduli(const DesignRequest& request) {
  if (!is_incompressible(request)) return mechanics::elastic_moduli(designed_material(request, -1));
  const double mu = small_strain_material(request.material).youngs_modulus / 3;
  return {incompressible_lambda_over_mu * mu, mu, (incompressible_lambda_over_mu + 2. / 3) * mu};
}

} // namespace springproof::msm
