#include "msm/design/design.hpp"

#include "cases/case/error.hpp"
#include "msm/design/midline.hpp"
#include "msm/design/multi_load.hpp"
#include "msm/design/small_strain.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace springproof::msm {

namespace {

constexpr double newton_per_metre = 1e-3; // N/mm

/// Range of axial logarithmic strain in which the thesis fits its references (section 5.2.2).
constexpr double largest_ogden_strain = 0.4;
constexpr double largest_linear_strain = 0.1;

/// Logarithmic strains (simple shear: amounts) of the multi-load fit when the case does not say. Hookean
/// springs stiffen less than soft tissue: a wider range buys accuracy at large strains with a lattice too
/// stiff at small ones; with this one both errors on the thesis's cube are alike.
constexpr std::array<double, 2> ogden_range = {-0.15, 0.15};
constexpr std::array<double, 2> linear_range = {-0.05, 0.05};

/// The same of the matched design, whose springs follow the curve.
constexpr std::array<double, 2> matched_range = {-0.2, 0.2};

/// Relative errors of energies from which a lattice's distance from its material is told: a tenth of the
/// errors that designs of isotropic materials have on a body.
constexpr double told_misfit = 2e-3;

DesignResult of_terms(std::vector<CellTerms> kinds) {
  DesignResult result;
  result.springs = BodyTerms{std::move(kinds)};
  return result;
}

DesignResult in_cell(const DesignRequest& request, const CellStiffness& four, const CubicModuli& moduli) {
  const auto k = by_axis_where_needed(four, moduli, split(request), request.cell);
  return k ? of_terms({terms_by_axis(*k)}) : DesignResult{four};
}

DesignResult from_linear_method(const DesignRequest& request) {
  const cases::LinearElastic material = designed_material(request, 0);
  const LinearFit fit = linear_method(request.element_stiffness(material), request.cell);
  return {fit.stiffness, fit.residual};
}

DesignResult from_moduli_method(const DesignRequest& request) {
  // E = 3 mu, G = mu is the finite limit of incompressibility, which a hyperelastic material without bulk
  // modulus means.
  const cases::LinearElastic material =
      is_incompressible(request) ? small_strain_material(request.material) : designed_material(request, -1);
  const double mu = mechanics::elastic_moduli(material).mu;
  return in_cell(request, moduli_method(material.youngs_modulus, mu, split(request), request.cell),
                 {c11_of_springs(material.youngs_modulus, mu), mu, 0});
}

/// Below nu = 1/4 the volume term is negative. In a cube the springs outweigh it; in another cell they may
/// not, and cells that are stable alone are stable together.
DesignResult from_hybrid_method(const DesignRequest& request) {
  if (!is_incompressible(request)) designed_material(request, 0);
  const auto [lambda, mu, kappa] = elastic_moduli(request);
  DesignResult result =
      in_cell(request, hybrid_method(lambda, mu, split(request), request.cell), {3 * mu, mu, lambda - mu});
  const BodyTerms* terms = result.springs.terms();
  const CellTerms cell = terms ? terms->kinds.front() : terms_of(result.stiffness);
  if (cell.volume < 0 && signs_at_rest(cell_stiffness_matrix(request.cell, cell)).n_negative > 0)
    refuse(request,
           fmt::format("design = \"{}\": below nu = 0.25 the volume term is negative, and the springs "
                       "of this cell do not outweigh it",
                       name_of(request.options.design)));
  return result;
}

DesignResult from_matched_method(const DesignRequest& request) {
  DesignResult result = from_hybrid_method(request);
  if (request.options.exponent) return result;
  const cases::Material material = cases::is_hyperelastic(request.material)
                                       ? request.material
                                       : cases::Material(designed_material(request, 0));
  const MatchedFit fit = matched_exponents(material, elastic_moduli(request), split(request),
                                           request.options.strain_range.value_or(matched_range));
  result.stiffness.exponents = fit.exponents;
  result.residual = fit.objective;
  return result;
}

DesignResult from_multi_load(const DesignRequest& request) {
  const cases::Msm& options = request.options;
  cases::Material material = request.material;
  if (std::holds_alternative<cases::LinearElastic>(material) || options.poissons_ratio)
    material = designed_material(request, -1);
  const double edge = required_cube_edge(request);
  MultiLoadSettings settings;
  settings.paths = options.paths;
  if (settings.paths.empty())
    for (const std::string& name : cases::all_names<cases::LoadPath>())
      settings.paths.push_back(*cases::value_of<cases::LoadPath>(name));
  settings.weights = options.weights;
  if (settings.weights.empty()) settings.weights.assign(settings.paths.size(), 1);
  const auto range = options.strain_range.value_or(law_kind(request) == LawKind::power_log
                                                       ? matched_range
                                                       : by_material(request, ogden_range, linear_range));
  settings.lowest_strain = range[0];
  settings.highest_strain = range[1];
  settings.has_volume_term = options.has_volume_term;
  settings.incompressible_lambda = elastic_moduli(request).lambda;
  settings.split = split(request); // free, it would take all internal or all face diagonals: homogeneous
                                   // states hardly tell them apart
  settings.exponents = law_of(request);
  if (!finds_exponents(request)) {
    const MultiLoadFit fit = multi_load_method(material, edge, settings);
    return {fit.stiffness, fit.objective};
  }
  const mechanics::ElasticModuli moduli = elastic_moduli(request);
  const double nu = mechanics::linear_elastic(moduli.mu, moduli.kappa).poissons_ratio;
  const MultiLoadFit fit = multi_load_with_exponents(
      material, edge, settings,
      closed_form_exponent(second_order_coefficient(material, nu), moduli, *settings.split));
  return {fit.stiffness, fit.objective};
}

/// E of the design, where nothing else of the material enters.
double required_youngs_modulus(const DesignRequest& request) {
  const double youngs_modulus = small_strain_material(request.material).youngs_modulus;
  if (!(youngs_modulus > 0) || !std::isfinite(youngs_modulus))
    refuse(request, "Young's modulus: must be positive and finite");
  return youngs_modulus;
}

DesignResult from_baudet(const DesignRequest& request) {
  const cases::LinearElastic material = is_incompressible(request) ? small_strain_material(request.material)
                                                                   : designed_material(request, -0.25);
  DesignResult result{baudet(material.youngs_modulus, material.poissons_ratio, required_cube_edge(request))};
  if (std::abs(material.poissons_ratio - 0.25) > 1e-9)
    result.warnings.push_back(
        "the published design corrects its Poisson's ratio by lateral forces without an energy; they are "
        "left out, and these are its springs alone");
  return result;
}

DesignResult from_uniform(const DesignRequest& request) {
  const auto& given = request.options.uniform_stiffness;
  const double k = given ? newton_per_metre * *given
                         : uniform_stiffness(required_youngs_modulus(request), required_cube_edge(request));
  DesignResult result{uniform_springs(k)};
  result.springs = BodyTerms{{terms_of(result.stiffness)}, {}, Boundary::whole};
  return result;
}

/// Where no stiffness is negative the lattice is stable at rest; where one is, the others may outweigh it.
DesignResult from_transverse(const DesignRequest& request) {
  const auto& material = std::get<cases::TransverselyIsotropic>(request.material);
  const auto axis = cases::axis_along(material.fibre);
  if (!axis)
    refuse(request, fmt::format("design = \"{}\": material.fibre is ({:g}, {:g}, {:g}), must lie along "
                                "an axis of the grid: \"x\" | \"y\" | \"z\"",
                                cases::name_of(request.options.design), material.fibre.x(),
                                material.fibre.y(), material.fibre.z()));
  const double edge = required_cube_edge(request);
  const NearestModuli nearest = nearest_lattice_moduli(mechanics::transverse_moduli(material));
  const AxisStiffness k = stiffness_by_axis(nearest.moduli, split(request), static_cast<int>(*axis), edge);
  const CellTerms terms = terms_by_axis(k);
  if (signs_at_rest(cell_stiffness_matrix(request.cell, terms)).n_negative > 0)
    refuse(request, fmt::format("design = \"{}\": springs cannot follow this material. Their moduli have "
                                "C12 - C66 = C13 - C44; the nearest ones err by {:.3g} % in the energy of a "
                                "strain, and need negative springs that the others do not outweigh",
                                cases::name_of(request.options.design), 100 * nearest.misfit));
  DesignResult result = of_terms({terms});
  result.residual = nearest.distance;
  if (nearest.misfit > told_misfit)
    result.warnings.push_back(
        fmt::format("the lattice's moduli, C12 - C66 = C13 - C44, are the nearest to the "
                    "material's: the energies of strains err by up to {:.2g} %",
                    100 * nearest.misfit));
  result.by_fibre = nearest;
  return result;
}

DesignResult from_midline_method(const DesignRequest& request) {
  const bool is_isotropic = cases::is_isotropic(request.material);
  DesignResult result = !is_isotropic                             ? from_transverse(request)
                        : law_kind(request) == LawKind::power_log ? from_matched_method(request)
                                                                  : from_hybrid_method(request);
  const double beta = request.options.beta.value_or(default_beta(request.cells_across));
  if (auto* const terms = std::get_if<BodyTerms>(&result.springs.kind)) {
    add_midlines(terms->kinds.front(), request.cell, beta);
    return result;
  }
  const auto [lambda, mu, kappa] = elastic_moduli(request);
  const double nu = mechanics::linear_elastic(mu, kappa).poissons_ratio;
  result.stiffness = with_midlines(result.stiffness, edge_part(nu, split(request), beta));
  return result;
}

DesignResult from_given(const DesignRequest& request) {
  const cases::Msm& options = request.options;
  if (options.axis_stiffness) {
    AxisStiffness stiffness{*options.axis_stiffness, options.volume_stiffness};
    for (double& k : stiffness.springs) k *= newton_per_metre;
    return of_terms({terms_by_axis(stiffness)});
  }
  if (!options.stiffness) refuse(request, "design = \"given\" needs stiffness = [k_e, k_f, k_d] in N/m");
  const auto& [edge, face_diagonal, internal_diagonal] = *options.stiffness;
  return {{newton_per_metre * edge, newton_per_metre * face_diagonal, newton_per_metre * internal_diagonal,
           options.volume_stiffness}};
}

DesignResult designed(const DesignRequest& r) {
  using D = cases::Design;
#pragma GCC diagnostic error "-Wswitch" // a design that is forgotten here must not compile
  switch (r.options.design) {
  case D::linear_method:
    return from_linear_method(r);
  case D::nonlinear_method: {
    const NonlinearFit fit = nonlinear_method(uniaxial_reference(r), required_cube_edge(r));
    return {fit.stiffness, fit.objective};
  }
  case D::moduli:
    return from_moduli_method(r);
  case D::hybrid:
    return from_hybrid_method(r);
  case D::matched:
    return from_matched_method(r);
  case D::midline:
    return from_midline_method(r);
  case D::multi_load:
    return from_multi_load(r);
  case D::ladd_kinney:
    return {ladd_kinney(required_youngs_modulus(r), required_cube_edge(r))};
  case D::baudet:
    return from_baudet(r);
  case D::uniform:
    return from_uniform(r);
  case D::van_gelder:
    return of_terms(van_gelder(r.cell, required_youngs_modulus(r)));
  case D::lloyd:
    return of_terms(lloyd(r.cell, required_youngs_modulus(r)));
  case D::biquadratic:
    return of_terms(biquadratic(elastic_moduli(r).lambda, elastic_moduli(r).mu));
  case D::transverse:
    return from_transverse(r);
  case D::given:
    return from_given(r);
  case D::network:
    break;
  }
  refuse(r, "design = \"network\" has springs of a whole body, and no cell");
}

} // namespace

std::vector<cases::Design> methods(const cases::Material& material) {
  std::vector<cases::Design> all;
  for (const cases::DesignFacts& facts : cases::all_designs())
    if (facts.source == cases::DesignSource::material &&
        cases::is_for(facts.design, cases::is_isotropic(material)))
      all.push_back(facts.design);
  return all;
}

UniaxialCurve uniaxial_reference(const DesignRequest& request, std::optional<double> largest_strain) {
  if (request.uniaxial_reference) return *request.uniaxial_reference;
  const double nu =
      request.options.poissons_ratio.value_or(small_strain_material(request.material).poissons_ratio);
  if (!(nu > 0 && nu <= 0.5))
    refuse(request, fmt::format("Poisson's ratio {:f}: the nonlinear method takes 0 < nu <= 0.5", nu));
  StrainRange range = {0, by_material(request, largest_ogden_strain, largest_linear_strain)};
  if (request.options.strain_range)
    range = {(*request.options.strain_range)[0], (*request.options.strain_range)[1]};
  if (largest_strain) range.highest = *largest_strain;
  if (const auto* ogden = std::get_if<cases::Ogden>(&request.material))
    return sample(ogden_law(*ogden), nu, range);
  if (const auto* yeoh = std::get_if<cases::Yeoh>(&request.material))
    return sample(yeoh_law({yeoh->c10, yeoh->c20, yeoh->c30}), nu, range);
  const double youngs_modulus = std::get<cases::LinearElastic>(request.material).youngs_modulus;
  if (!(youngs_modulus > 0) || !std::isfinite(youngs_modulus))
    refuse(request, "Young's modulus: must be positive and finite");
  return sample([=](double stretch) { return youngs_modulus * std::log(stretch); }, nu, range);
}

void set_law(cases::Msm& options, const std::optional<Exponents>& exponents) {
  options.law = kind_of(exponents);
  if (exponents) options.exponent = exponents->by_kind;
}

DesignResult design(const DesignRequest& request) {
  const cases::Msm& options = request.options;
  if (options.exponent && cases::facts_of(options.design).law == cases::DesignLaw::hooke)
    refuse(request, fmt::format("design = \"{}\" fits Hooke's springs: law must be \"hooke\"",
                                name_of(options.design)));
  const bool is_isotropic = cases::is_isotropic(request.material);
  if (!cases::is_for(options.design, is_isotropic))
    refuse(request, fmt::format("design = \"{}\": must be {} with this {} material", name_of(options.design),
                                cases::designs_for(is_isotropic),
                                is_isotropic ? "isotropic" : "transversely isotropic"));
  DesignResult result = designed(request);
  if (const auto law = law_of(request)) result.stiffness.exponents = law;
  std::vector<CellTerms> kinds{terms_of(result.stiffness)};
  if (auto* const terms = std::get_if<BodyTerms>(&result.springs.kind)) {
    if (const auto& law = result.stiffness.exponents)
      for (CellTerms& kind : terms->kinds) set_exponents(kind, *law);
    kinds = terms->kinds;
  } else {
    result.springs = {result.stiffness};
  }
  const std::vector<std::string> doubts = examine(kinds.front(), request.cell);
  result.warnings.insert(result.warnings.begin(), doubts.begin(), doubts.end());
  const Elasticity elasticity = cell_elasticity(kinds, request.cell);
  result.moduli = averaged_moduli(elasticity);
  const auto material = elasticity_at_rest(request.material);
  if (material && !request.uniaxial_reference && !result.by_fibre) { // which tells of its own misfit
    result.misfit = moduli_misfit(elasticity, *material);
    if (!(result.misfit->largest <= told_moduli_misfit)) result.warnings.push_back(result.misfit->text);
  }
  const auto range = options.strain_range.value_or(matched_range);
  const double edge = cube_edge(request.cell);
  if (finds_exponents(request) && edge > 0 && !is_stable_over(range, result.stiffness, edge))
    result.warnings.push_back(fmt::format(
        "a large lattice of these cells is not stable over the logarithmic strains from {:g} to {:g} of "
        "its exponents: waves of two cells may grow in it",
        range[0], range[1]));
  return result;
}

} // namespace springproof::msm
