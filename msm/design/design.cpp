#include "msm/design/design.hpp"

#include "cases/case/error.hpp"
#include "cases/case/names.hpp"
#include "mechanics/elastic_moduli.hpp"
#include "msm/design/matched.hpp"
#include "msm/design/moduli_method.hpp"
#include "msm/design/multi_load.hpp"
#include "msm/design/nonlinear_method.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <fmt/format.h>
#include <map>

namespace springproof::msm {

namespace {

constexpr double newton_per_metre = 1e-3; // N/mm

/// The share of the shear stiffness that the internal diagonals carry when the case does not say.
/// Small-strain accuracy in torsion asks for much of it (0.8); but the lattice loses its stability the
/// sooner, the more they carry: with 0.8 at a stretch of about 1.4, with 0.5 at 2.7. So a material for large
/// strains gets less.
constexpr double small_strain_split = 0.8;
constexpr double large_strain_split = 0.5;

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

/// lambda/mu of the volume term for an incompressible material: volumes hold to about 0.1 %, and Newton's
/// method still converges in few steps.
constexpr double incompressible_lambda_over_mu = 200;

[[noreturn]] void refuse(const DesignRequest& request, const std::string& problem) {
  throw cases::InputError(request.options.where, problem);
}

template<class Value>
Value by_material(const DesignRequest& request, const Value& ogden, const Value& linear_elastic) {
  return std::holds_alternative<cases::Ogden>(request.material) ? ogden : linear_elastic;
}

/// The small-strain material that the design is made for: options.poissons_ratio replaces the material's own,
/// E stays.
/// @throws InputError unless E > 0 and nu lies in [lowest, 0.5)
cases::LinearElastic designed_material(const DesignRequest& request, double lowest_poissons_ratio) {
  cases::LinearElastic material = small_strain_material(request.material);
  const cases::Msm& options = request.options;
  if (options.poissons_ratio) material.poissons_ratio = *options.poissons_ratio;
  if (!(material.youngs_modulus > 0) || !std::isfinite(material.youngs_modulus))
    refuse(request,
           fmt::format("Young's modulus {:f} MPa: must be positive and finite", material.youngs_modulus));
  if (!(material.poissons_ratio >= lowest_poissons_ratio && material.poissons_ratio < 0.5))
    refuse(request, fmt::format("Poisson's ratio {:f}: design = \"{}\" takes {:f} <= nu < 0.5; "
                                "msm.poissons_ratio designs from another one",
                                material.poissons_ratio, name_of(options.design), lowest_poissons_ratio));
  return material;
}

/// Edge of the request's cell.  @throws InputError when it is not a cube
double required_cube_edge(const DesignRequest& request) {
  const double edge = cube_edge(request.cell);
  if (edge > 0) return edge;
  refuse(request, fmt::format("design = \"{}\" is for cubical cells aligned with the axes",
                              name_of(request.options.design)));
}

double split(const DesignRequest& request) {
  const bool keeps_its_curve = request.options.design == cases::Design::matched;
  const double t = request.options.split.value_or(
      keeps_its_curve ? small_strain_split : by_material(request, large_strain_split, small_strain_split));
  if (t >= 0 && t <= 1) return t;
  refuse(request, fmt::format("split = {:f}: must lie in [0, 1]", t));
}

bool is_incompressible(const DesignRequest& request) {
  const auto* ogden = std::get_if<cases::Ogden>(&request.material);
  return ogden != nullptr && !ogden->bulk_modulus && !request.options.poissons_ratio;
}

mechanics::ElasticModuli elastic_moduli(const DesignRequest& request) {
  if (!is_incompressible(request)) return mechanics::elastic_moduli(designed_material(request, -1));
  const double mu = small_strain_material(request.material).youngs_modulus / 3;
  return {incompressible_lambda_over_mu * mu, mu, (incompressible_lambda_over_mu + 2. / 3) * mu};
}

/// A method's stiffnesses, and its objective at its minimum.
using Designed = std::pair<CellStiffness, std::optional<double>>;

Designed from_linear_method(const DesignRequest& request) {
  const cases::LinearElastic material = designed_material(request, 0);
  const LinearFit fit = linear_method(request.element_stiffness(material), request.cell);
  return {fit.stiffness, fit.residual};
}

Designed from_moduli_method(const DesignRequest& request) {
  // E = 3 mu, G = mu is the finite limit of incompressibility, which an Ogden material without bulk modulus
  // means.
  const cases::LinearElastic material =
      is_incompressible(request) ? small_strain_material(request.material) : designed_material(request, -1);
  const double mu = mechanics::elastic_moduli(material).mu;
  return {moduli_method(material.youngs_modulus, mu, split(request), request.cell), {}};
}

/// Eigenvalues of a cell's tangent at rest that are no round-off.
struct Signs {
  Eigen::Index n_negative, n_zero;
};

Signs signs_at_rest(const CellStiffness& stiffness, const CellVertices& vertices) {
  const CellMatrix matrix = cell_stiffness_matrix(vertices, stiffness);
  const auto eigenvalues =
      Eigen::SelfAdjointEigenSolver<CellMatrix>(matrix, Eigen::EigenvaluesOnly).eigenvalues().eval();
  // Far above round-off, far below any spring's share.
  const double zero = 1e-9 * eigenvalues.cwiseAbs().maxCoeff();
  return {(eigenvalues.array() < -zero).count(), (eigenvalues.array().abs() <= zero).count()};
}

/// Below nu = 1/4 the volume term is negative. In a cube the springs outweigh it; in another cell they may
/// not, and cells that are stable alone are stable together.
Designed from_hybrid_method(const DesignRequest& request) {
  if (!is_incompressible(request)) designed_material(request, 0);
  const auto [lambda, mu, kappa] = elastic_moduli(request);
  const CellStiffness stiffness = hybrid_method(lambda, mu, split(request), request.cell);
  if (stiffness.volume < 0 && signs_at_rest(stiffness, request.cell).n_negative > 0)
    refuse(request,
           fmt::format("design = \"{}\": below nu = 0.25 the volume term is negative, and the springs "
                       "of this cell do not outweigh it",
                       name_of(request.options.design)));
  return {stiffness, {}};
}

Designed from_matched_method(const DesignRequest& request) {
  Designed result = from_hybrid_method(request);
  if (request.options.exponent) return result;
  const bool is_ogden = std::holds_alternative<cases::Ogden>(request.material);
  const cases::Material material =
      is_ogden ? request.material : cases::Material(designed_material(request, 0));
  const MatchedFit fit = matched_exponents(material, elastic_moduli(request), split(request),
                                           request.options.strain_range.value_or(matched_range));
  result.first.exponents = fit.exponents;
  result.second = fit.objective;
  return result;
}

Designed from_nonlinear_method(const DesignRequest& request) {
  const NonlinearFit fit = nonlinear_method(uniaxial_reference(request), required_cube_edge(request));
  return {fit.stiffness, fit.objective};
}

Designed from_multi_load(const DesignRequest& request) {
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
  const auto range = options.strain_range.value_or(by_material(request, ogden_range, linear_range));
  settings.lowest_strain = range[0];
  settings.highest_strain = range[1];
  settings.has_volume_term = options.has_volume_term;
  settings.incompressible_lambda = elastic_moduli(request).lambda;
  settings.split = split(request); // free, it would take all internal or all face diagonals: homogeneous
                                   // states hardly tell them apart
  const MultiLoadFit fit = multi_load_method(material, edge, settings);
  return {fit.stiffness, fit.objective};
}

Designed from_given(const DesignRequest& request) {
  const cases::Msm& options = request.options;
  if (!options.stiffness) refuse(request, "design = \"given\" needs stiffness = [k_e, k_f, k_d] in N/m");
  const auto& [edge, face_diagonal, internal_diagonal] = *options.stiffness;
  return {{newton_per_metre * edge, newton_per_metre * face_diagonal, newton_per_metre * internal_diagonal,
           options.volume_stiffness},
          {}};
}

const std::map<cases::Design, Designed (*)(const DesignRequest&)> known_methods = {
    {cases::Design::linear_method, from_linear_method},
    {cases::Design::nonlinear_method, from_nonlinear_method},
    {cases::Design::moduli, from_moduli_method},
    {cases::Design::hybrid, from_hybrid_method},
    {cases::Design::matched, from_matched_method},
    {cases::Design::multi_load, from_multi_load},
    {cases::Design::given, from_given},
};

/// Reasons not to trust a cell: negative stiffnesses, a mechanism (more than the six rigid modes), an
/// indefinite tangent at rest.
std::vector<std::string> examine(const CellStiffness& stiffness, const CellVertices& vertices) {
  std::vector<std::string> warnings;
  for (const auto& [name, value] : {std::pair("edge springs k_e", stiffness.edge),
                                    {"face diagonals k_f", stiffness.face_diagonal},
                                    {"internal diagonals k_d", stiffness.internal_diagonal},
                                    {"volume term k_v", stiffness.volume}}) {
    if (!std::isfinite(value)) return {fmt::format("{}: the stiffness is not a finite number", name)};
    if (value < 0) warnings.push_back(fmt::format("{}: the stiffness is negative", name));
  }
  const auto [n_negative, n_zero] = signs_at_rest(stiffness, vertices);
  if (n_negative > 0)
    warnings.push_back(
        fmt::format("the cell's tangent at rest is indefinite: {} negative eigenvalues", n_negative));
  if (n_zero > 6)
    warnings.push_back(
        fmt::format("the cell is a mechanism: {} zero-energy modes besides the rigid motions", n_zero - 6));
  return warnings;
}

} // namespace

std::vector<cases::Design> methods() {
  std::vector<cases::Design> all;
  for (const auto& [method, run] : known_methods)
    if (method != cases::Design::given) all.push_back(method);
  return all;
}

cases::LinearElastic small_strain_material(const cases::Material& material) {
  if (const auto* linear = std::get_if<cases::LinearElastic>(&material)) return *linear;
  const auto& ogden = std::get<cases::Ogden>(material);
  const double mu = mechanics::shear_modulus(ogden);
  if (!ogden.bulk_modulus) return {3 * mu, 0.5};
  return mechanics::linear_elastic(mu, *ogden.bulk_modulus);
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
  const double youngs_modulus = std::get<cases::LinearElastic>(request.material).youngs_modulus;
  if (!(youngs_modulus > 0) || !std::isfinite(youngs_modulus))
    refuse(request, "Young's modulus: must be positive and finite");
  return sample([=](double stretch) { return youngs_modulus * std::log(stretch); }, nu, range);
}

DesignResult design(const DesignRequest& request) {
  const cases::Msm& options = request.options;
  if (options.exponent && fits_hooke(options.design))
    refuse(request, fmt::format("design = \"{}\" fits Hooke's springs: law must be \"hooke\"",
                                name_of(options.design)));
  auto [stiffness, residual] = known_methods.at(options.design)(request);
  if (const auto& p = options.exponent) stiffness.exponents = Exponents{(*p)[0], (*p)[1], (*p)[2]};
  DesignResult result{stiffness, residual, lattice_moduli(stiffness, request.cell),
                      examine(stiffness, request.cell)};
  const auto range = options.strain_range.value_or(matched_range);
  const double edge = cube_edge(request.cell);
  if (options.design == cases::Design::matched && edge > 0 && !is_stable_over(range, stiffness, edge))
    result.warnings.push_back(fmt::format(
        "a large lattice of these cells is not stable over the logarithmic strains from {:g} to {:g} of "
        "its exponents: waves of two cells may grow in it",
        range[0], range[1]));
  return result;
}

} // namespace springproof::msm
