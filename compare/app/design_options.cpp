#include "compare/app/commands.hpp"

#include "cases/case/input_file.hpp"
#include "cases/case/names.hpp"
#include "cases/case/read_case.hpp"
#include "cases/case/readers.hpp"
#include "compare/provenance/whole_file.hpp"
#include "compare/solve/estimate.hpp"
#include "compare/solve/springs.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numeric>

namespace springproof::compare {

namespace {

cases::Ogden checked(const cases::Ogden& ogden) {
  const double shear_modulus = std::accumulate(ogden.mu.begin(), ogden.mu.end(), 0.0);
  if (ogden.mu.size() != ogden.alpha.size())
    throw cases::InputError("command line: --ogden-mu and --ogden-alpha must be equally many numbers");
  if (std::count(ogden.alpha.begin(), ogden.alpha.end(), 0) > 0)
    throw cases::InputError("command line: --ogden-alpha: none may be 0");
  if (!(shear_modulus > 0))
    throw cases::InputError("command line: the initial shear modulus must be positive, it is " +
                            std::to_string(shear_modulus) + " MPa");
  return ogden;
}

/// A curve's material at small strains: its secant at the strain that is closest to 0, and not 0.
cases::Material at_rest(const msm::UniaxialCurve& curve) {
  std::size_t nearest = curve.axial_strain[0] == 0 ? 1 : 0;
  for (std::size_t i = 0; i < curve.axial_strain.size(); ++i)
    if (curve.axial_strain[i] != 0 && std::abs(curve.axial_strain[i]) < std::abs(curve.axial_strain[nearest]))
      nearest = i;
  const double strain = curve.axial_strain[nearest], youngs_modulus = curve.stress[nearest] / strain,
               poissons_ratio = -curve.lateral_strain[nearest] / strain;
  // An incompressible one has no linear law here.
  if (youngs_modulus > 0 && poissons_ratio == 0.5)
    return cases::Ogden{{youngs_modulus / 3}, {2}, std::nullopt};
  return cases::LinearElastic{youngs_modulus, poissons_ratio};
}

cases::Material material_of(const DesignOptions& o, const std::optional<msm::UniaxialCurve>& curve) {
  if (n_materials(o) != 1)
    throw cases::InputError(
        "command line: give one material: --young with --poisson, --ogden-mu with --ogden-alpha, "
        "--neo-hookean, --mooney-rivlin, --yeoh, --curve, or --case");
  if (!o.ogden_mu.empty()) return checked({o.ogden_mu, o.ogden_alpha, std::nullopt});
  if (o.neo_hookean != 0) return checked({{o.neo_hookean}, {2}, std::nullopt});
  if (const auto& c = o.mooney_rivlin; !c.empty()) return checked(cases::mooney_rivlin(c.at(0), c.at(1)));
  if (!o.yeoh.empty()) // its small-strain material is neo-Hookean
    return checked({{2 * o.yeoh.at(0)}, {2}, std::nullopt});
  if (curve) return at_rest(*curve);
  if (!(o.poissons_ratio > -1))
    throw cases::InputError("command line: --poisson: must be given with --young, above -1 and below 0.5");
  return cases::LinearElastic{o.youngs_modulus, o.poissons_ratio};
}

/// Bound on logarithmic strains, as in case files.
constexpr double largest_allowed_strain = 2;

/// @throws InputError for an end of the strains that is none, or that nothing here has a use for
void check_largest_strain(const DesignOptions& o) {
  if (!o.largest_strain) return;
  if (!(0 < *o.largest_strain && *o.largest_strain <= largest_allowed_strain))
    throw cases::InputError(
        fmt::format("command line: --largest-strain: is {:g}, must be above 0 and at most {:g}",
                    *o.largest_strain, largest_allowed_strain));
  if (!o.curve_file.empty() || !o.case_file.empty())
    throw cases::InputError("command line: --largest-strain: must be left out with --curve and --case, which "
                            "bring their own strains");
}

/// Which --poisson says in place of a material's own.
std::optional<double> other_poissons_ratio(const DesignOptions& o) {
  return o.poissons_ratio > -1 ? std::optional(o.poissons_ratio) : std::nullopt;
}

/// Numbers do not tell which strain, which stress and which unit they are.
msm::CurveColumns columns_of(const DesignOptions& o) {
  const auto strain = cases::value_of<msm::CurveStrain>(o.curve_strain);
  const auto unit = cases::value_of<msm::CurveUnit>(o.curve_unit);
  if (!strain || !unit)
    throw cases::InputError(fmt::format(
        "command line: --curve: say what the columns of {} are: --strain {}, and --unit {} of the stresses "
        "(nominal ones with engineering strains and stretches, Cauchy ones with logarithmic strains, unless "
        "--stress says otherwise)",
        o.curve_file, cases::alternatives(cases::all_names<msm::CurveStrain>()),
        cases::alternatives(cases::all_names<msm::CurveUnit>())));
  const auto beside =
      strain == msm::CurveStrain::logarithmic ? msm::CurveStress::cauchy : msm::CurveStress::nominal;
  return {*strain, cases::value_of<msm::CurveStress>(o.curve_stress).value_or(beside), *unit,
          other_poissons_ratio(o)};
}

std::optional<msm::UniaxialCurve> curve_of(const DesignOptions& o) {
  if (!o.curve_file.empty()) return measured_curve(o);
  if (!o.curve_strain.empty() || !o.curve_stress.empty() || !o.curve_unit.empty())
    throw cases::InputError("command line: --strain, --stress and --unit are of the columns of --curve");
  if (o.yeoh.empty()) return std::nullopt;
  const double thesis_end = 0.4; // end of its Ogden reference
  return msm::sample(msm::yeoh_law(o.yeoh), other_poissons_ratio(o).value_or(0.5),
                     {0, o.largest_strain.value_or(thesis_end)});
}

msm::DesignRequest from_command_line(const DesignOptions& o, cases::Element element) {
  const auto curve = curve_of(o);
  msm::DesignRequest request =
      design_request(material_of(o, curve), msm::cube(o.edge), cases::Msm{}, element);
  const double stiffness = msm::small_strain_material(request.material).youngs_modulus;
  if (!(std::abs(stiffness) <= 1e12)) // squares and cubes are taken of it
    throw cases::InputError(
        fmt::format("command line: Young's modulus is {:g}, must be at most 1e12 (MPa)", stiffness));
  request.uniaxial_reference = curve;
  const auto nu = other_poissons_ratio(o);
  if (o.youngs_modulus == 0 && !curve && nu && *nu < 0.5) request.options.poissons_ratio = nu;
  // A curve is followed by one design alone; of the others a material's moduli are left.
  request.options.design = curve ? cases::Design::nonlinear_method
                                 : cases::default_design({request.material}, request.options.poissons_ratio);
  if (!curve && o.largest_strain)
    request.uniaxial_reference = msm::uniaxial_reference(request, o.largest_strain);
  return request;
}

msm::DesignRequest from_case(const DesignOptions& o, cases::Element element) {
  if (n_materials(o) > 0)
    throw cases::InputError("command line: --case brings its own material; leave the others out");
  const cases::Scene scene = make_scene_within_memory(cases::read_case(o.case_file, o.settings));
  cases::refuse_network(scene.definition, "--case", "give a case whose body has cells");
  if (scene.mesh.shape == cases::CellShape::tetrahedron)
    throw cases::InputError(o.case_file +
                            ": --case designs one hexahedral cell, and the springs of tetrahedra "
                            "are fitted to the whole mesh: springproof design CASE tells what they can do");
  return design_request(scene.definition.material, cases::cell_vertices(scene.mesh, 0), scene.definition.msm,
                        element);
}

} // namespace

int n_materials(const DesignOptions& o) {
  return (o.youngs_modulus != 0) + !o.ogden_mu.empty() + !o.mooney_rivlin.empty() + (o.neo_hookean != 0) +
         !o.yeoh.empty() + !o.curve_file.empty();
}

msm::UniaxialCurve measured_curve(const DesignOptions& o) {
  const msm::CurveColumns columns = columns_of(o);
  return msm::read_curve(cases::read_text_file(o.curve_file), o.curve_file, columns);
}

CLI::Option* add_curve_options(CLI::App& command, DesignOptions& o) {
  CLI::Option* curve = command.add_option(
      "--curve", o.curve_file,
      "measured uniaxial curve, CSV: strain, stress [, lateral strain]; with --strain and --unit");
  command.add_option("--strain", o.curve_strain, "what the strains of --curve are")
      ->check(CLI::IsMember(cases::all_names<msm::CurveStrain>()));
  command
      .add_option(
          "--stress", o.curve_stress,
          "what the stresses of --curve are; cauchy with logarithmic strains, else nominal, when left out")
      ->check(CLI::IsMember(cases::all_names<msm::CurveStress>()));
  command.add_option("--unit", o.curve_unit, "unit of the stresses of --curve")
      ->check(CLI::IsMember(cases::all_names<msm::CurveUnit>()));
  return curve;
}

void add_design_options(CLI::App& command, DesignOptions& o) {
  command.add_option("--case", o.case_file, "material, cell and method of a case file");
  add_set_option(command, o.settings, "override a key of the case: body.cells=[8,8,8], fem.refine=1");
  command.add_option("--young", o.youngs_modulus, "Young's modulus, MPa")->check(number_between(1e-12, 1e12));
  command
      .add_option("--poisson", o.poissons_ratio,
                  "Poisson's ratio; beside another material than --young: to design for in place of its own")
      ->check(number_between(-0.9999, 0.5));
  command.add_option("--edge", o.edge, "edge of the cell, mm")
      ->check(number_between(1e-6, 1e6))
      ->capture_default_str();
  command.add_option("--method", o.method, "design method")
      ->check(CLI::IsMember(cases::all_names<cases::Design>()));
  command
      .add_option("--split", o.split,
                  "0 to 1: t of the shear stiffness in internal diagonals; with " +
                      cases::designs_with("split"))
      ->check(number_between(0, 1));
  command
      .add_option("--beta", o.beta,
                  "above 0, at most 2: resistance to bending over a slender bar's; with " +
                      cases::designs_with("beta"))
      ->check(number_between(1e-6, 2));
  command.add_option("--element", o.element, "element of the linear method's K_FEM")
      ->check(CLI::IsMember({"q1", "q1_bbar"}))
      ->capture_default_str();
  command.add_option("--ogden-mu", o.ogden_mu, "Ogden's mu_i, MPa")->check(number_between(-1e12, 1e12));
  command.add_option("--ogden-alpha", o.ogden_alpha, "Ogden's alpha_i")->check(number_between(-1000, 1000));
  command.add_option("--neo-hookean", o.neo_hookean, "shear modulus mu, MPa")
      ->check(number_between(1e-12, 1e12));
  command.add_option("--mooney-rivlin", o.mooney_rivlin, "C10 and C01, MPa")
      ->expected(2)
      ->check(number_between(-1e12, 1e12));
  command.add_option("--yeoh", o.yeoh, "C1, C2, ..., MPa")->check(number_between(-1e12, 1e12));
  add_curve_options(command, o);
  command.add_option("--largest-strain", o.largest_strain,
                     "end of the reference curve's logarithmic strains");
  command.add_option("--paths", o.paths, "deformations that the multi-load method fits; all when left out")
      ->check(CLI::IsMember(cases::all_names<cases::LoadPath>()));
  command.add_option("--strain-range", o.strain_range, "logarithmic strains that the fits cover")
      ->expected(2)
      ->check(number_between(-largest_allowed_strain, largest_allowed_strain));
  command
      .add_option("--law", o.law, "law of the multi-load method's springs; power_log: it fits exponents too")
      ->check(CLI::IsMember(cases::all_names<cases::SpringLaw>()));
  command.add_flag("--springs-only", o.springs_only, "the multi-load method without its volume term");
}

CLI::Option* add_designs_option(CLI::App& command, std::vector<std::string>& names, const std::string& text) {
  std::vector<std::string> allowed = cases::all_names<cases::Design>();
  allowed.insert(allowed.begin(), "all");
  return command.add_option("--designs", names, text)
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::IsMember(allowed));
}

std::vector<cases::Design> designs_of(const std::vector<std::string>& names, const cases::Case& definition) {
  const bool are_all = std::count(names.begin(), names.end(), "all") > 0;
  std::vector<cases::Design> designs;
  if (are_all) designs = msm::methods(definition.material);
  if (are_all && std::count(designs.begin(), designs.end(), definition.msm.design) == 0)
    designs.push_back(definition.msm.design);
  if (!are_all)
    for (const std::string& name : names) designs.push_back(*cases::value_of<cases::Design>(name));
  return designs;
}

msm::DesignRequest request_from(const DesignOptions& o) {
  if (!o.settings.empty() && o.case_file.empty())
    throw cases::InputError("command line: --set: overrides keys of a case, which --case must name");
  check_largest_strain(o);
  const cases::Element element = *cases::value_of<cases::Element>(o.element);
  msm::DesignRequest request = o.case_file.empty() ? from_command_line(o, element) : from_case(o, element);
  if (!o.method.empty()) request.options.design = *cases::value_of<cases::Design>(o.method);
  if (o.split != -1) request.options.split = o.split;
  if (o.beta != -1) request.options.beta = o.beta;
  for (const std::string& path : o.paths)
    request.options.paths.push_back(*cases::value_of<cases::LoadPath>(path));
  if (!o.strain_range.empty()) request.options.strain_range = {o.strain_range.at(0), o.strain_range.at(1)};
  if (o.springs_only) request.options.has_volume_term = false;
  if (!o.law.empty()) {
    const cases::DesignLaw law = cases::facts_of(request.options.design).law;
    if (!o.method.empty() && law != cases::DesignLaw::fitted && law != cases::DesignLaw::fitted_or_hooke)
      throw cases::InputError(
          "--law: belongs to --method midline and multi_load; the law of other springs is in a case file");
    request.options.law = *cases::value_of<cases::SpringLaw>(o.law);
    request.options.exponent.reset();
  }
  return request;
}

} // namespace springproof::compare
