#include "cases/case/elements.hpp"
#include "cases/case/read_real_time.hpp"
#include "cases/case/readers.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <numeric>

namespace springproof::cases {

#pragma GCC diagnostic error "-Wswitch" // an enumerator that is forgotten here must not compile

namespace {

/// Lists the formulations for a material.  @param model  material.model of a case file
std::vector<Formulation> formulations_of(const std::string& model) {
  using F = Formulation;
  if (model == Ogden::name || model == Yeoh::name) return {F::hyperelastic};
  if (model == TransverselyIsotropic::name) return {F::small_strain, F::log_strain};
  return {F::small_strain, F::saint_venant_kirchhoff, F::log_strain};
}

std::string models_with(Formulation formulation) {
  std::vector<std::string> found;
  for (const std::string& model : Kinds<Material>::names())
    if (contains(formulations_of(model), formulation)) found.push_back(model);
  return alternatives(found);
}

/// "auto" falls back on the default.
void read_formulation(Table& table, const Material& material, Fem& fem) {
  std::vector<std::string> words = all_names<Formulation>();
  words.emplace_back("auto");
  const auto word = table.optional("formulation", [&](const Entry& entry) { return entry.word(words); });
  const bool has_finite_strains = is_hyperelastic(material);
  fem.has_auto_formulation = word == "auto";
  table.refuse_unless(
      !(fem.has_auto_formulation && has_finite_strains), {"formulation"},
      fmt::format("\"hyperelastic\" with the {} material, which has no small strains", name_of(material)));
  fem.formulation = value_of<Formulation>(word.value_or("auto"))
                        .value_or(has_finite_strains ? Formulation::hyperelastic : Formulation::log_strain);
  const std::vector<Formulation> allowed = formulations_of(name_of(material));
  table.refuse_unless(contains(allowed, fem.formulation), {"formulation"},
                      fmt::format("{} with model = \"{}\"; {} needs model = {}", alternatives(allowed),
                                  name_of(material), name_of(fem.formulation), models_with(fem.formulation)));
}

/// The elements required by the material, when this one is not among them; otherwise empty.
std::string element_needed(Element element, const Material& material) {
  if (!needs_pressure(material) || facts_of(element).has_pressure) return "";
  return fmt::format(
      "\"q1_p0\" | \"q1_bbar\" | \"q2_p1\", or \"p2_p0\" | \"p2_p1\" on tetrahedra, with model = "
      "\"{}\" without bulk_modulus: it is nearly incompressible, and a displacement element "
      "without averaged volume locks",
      name_of(material));
}

/// Elements of both shapes: which of them the body has is known with its mesh.
void read_element(Table& table, const Material& material, Fem& fem) {
  const auto named = table.optional("element", read_name<Element>);
  fem.has_auto_element = !named;
  std::vector<Element> allowed;
  for (const bool is_tetrahedron : {false, true})
    for (const Element element : elements_of(fem, is_tetrahedron)) allowed.push_back(element);
  const bool has_hexahedra = !elements_of(fem, false).empty();
  fem.element = named ? *named : default_element(fem, {material}, !has_hexahedra);
  const std::string beside = fem.real_time
                                 ? fmt::format("real_time.method = \"{}\"", name_of(fem.real_time->method))
                                 : fmt::format("formulation = \"{}\"", name_of(fem.formulation));
  table.refuse_unless(contains(allowed, fem.element), {"element"},
                      fmt::format("{} with {}", alternatives(allowed), beside));
  const std::string needed = element_needed(fem.element, material);
  if (!needed.empty() && !fem.real_time) table.entry("element").refuse(needed);
}

/// A mesh of that many nodes is numbered with int, three degrees of freedom each.
void check_refined_size(const Entry& entry, const Body& body, int refine) {
  const Box* box = std::get_if<Box>(&body);
  if (!box) return;
  double nodes = 1;
  for (int n : box->cells) nodes *= double(n) * double(1 << refine) + 1;
  if (!(3 * nodes < 2147483647.0))
    entry.refuse(
        fmt::format("fewer: the refined mesh would have {:.3g} nodes, above what can be numbered", nodes));
}

/// A list of names, each at most once.
template<class Enum>
std::vector<Enum> read_names(const Entry& entry) {
  std::vector<Enum> names;
  for (const Entry& element : entry.elements(alternatives(all_names<Enum>()))) {
    names.push_back(read_name<Enum>(element));
    if (std::count(names.begin(), names.end(), names.back()) > 1)
      element.refuse("one that is not in the list yet");
  }
  return names;
}

const std::string has_no_mass = "left out without material.density";

/// Beside a method of steps the elements are those that it takes, their masses lumped, and what a case
/// measures is of displacements.
void check_real_time(Table& table, const Fem& fem, const Case& definition) {
  const Entry entry = table.entry("real_time");
  check_steps(entry, "fem", definition);
  if (definition.fem_body) entry.refuse("left out beside [fem.body]");
  if (definition.dynamics && definition.dynamics->start == MotionStart::equilibrium && fem.refine > 0)
    entry.refuse("left out beside refine and dynamics.start = \"equilibrium\": refine the body's own mesh");
  if (table.has("mass") && fem.mass == ElementMass::consistent)
    entry.refuse("left out beside mass = \"consistent\": its masses are lumped");
  for (const Material& material : materials_of(definition))
    if (const std::string needed = steps_needed(fem.real_time->method, material); !needed.empty())
      entry.refuse(needed);
}

Fem read_fem(Table& table, const Case& definition) {
  const Material& material = definition.material;
  Fem fem;
  fem.where = table.where();
  table.know({"body"}); // read_fem_body()
  read_formulation(table, material, fem);
  fem.real_time = table.section_if_there(
      "real_time", [&](Table& section) { return read_real_time<ElementMethod>(section, definition); });
  read_element(table, material, fem);
  if (const auto refine = table.optional("refine", WholeNumber{"a whole number from 0 to 8", 0, 8})) {
    fem.refine = *refine;
    check_refined_size(table.entry("refine"), definition.fem_body.value_or(definition.body), fem.refine);
  }
  const auto accuracy = table.optional("accuracy", [](const Entry& entry) {
    return entry.word({"auto", "none"});
  });
  if (definition.dynamics && accuracy == "auto")
    table.entry("accuracy").refuse("\"none\" or left out beside [dynamics]: ask for --converge instead");
  fem.has_auto_accuracy = accuracy.value_or(definition.dynamics ? "none" : "auto") == "auto";
  table.refuse_unless(definition.dynamics || definition.material_dynamics.density, {"mass"}, has_no_mass);
  fem.mass = table.optional("mass", read_name<ElementMass>)
                 .value_or(fem.real_time ? ElementMass::lumped : ElementMass::consistent);
  if (fem.real_time) check_real_time(table, fem, definition);
  fem.accepted = table.optional("accept", read_names<Doubt>).value_or(std::vector<Doubt>{});
  return fem;
}

/// The requirement of the design on Poisson's ratio, when it is not met; otherwise empty.
std::string design_needed(const Msm& msm, const Material& material) {
  const LinearElastic* linear = std::get_if<LinearElastic>(&material);
  const bool is_incompressible = needs_pressure(material) && !msm.poissons_ratio;
  const DesignFacts& facts = facts_of(msm.design);
  if (facts.ratio.is_below_half && is_incompressible)
    return fmt::format("another design than \"{}\", which needs a Poisson's ratio below 0.5: this {} "
                       "material has none without bulk_modulus; or give msm.poissons_ratio",
                       name_of(msm.design), name_of(material));
  const double ratio = msm.poissons_ratio.value_or(linear ? linear->poissons_ratio : 0.5);
  if (const auto least = facts.ratio.least; least && ratio < *least)
    return fmt::format("another design than \"{}\", which needs a Poisson's ratio of {} and more, not {}",
                       name_of(msm.design), *least, ratio);
  return "";
}

/// Reads what a design by fits to curves is fitted to.
void read_fit(Table& table, Msm& msm) {
  msm.paths = table.optional("paths", read_names<LoadPath>).value_or(std::vector<LoadPath>{});
  const std::size_t n_paths = msm.paths.empty() ? all_names<LoadPath>().size() : msm.paths.size();
  const std::string per_path = fmt::format("{} numbers, none below 0 and not all 0: one per path", n_paths);
  if (const auto weights = table.optional("weights", Numbers{per_path, n_paths, is_not_negative})) {
    if (std::all_of(weights->begin(), weights->end(), [](double w) { return w == 0; }))
      table.entry("weights").refuse(per_path);
    msm.weights = *weights;
  }
  const auto is_allowed = [](double strain) { return strain >= -2 && strain <= 2; };
  msm.strain_range =
      table.optional("strain_range", Interval<>{"two numbers from -2 to 2, the smaller first", is_allowed});
  const auto volume_term = table.optional("volume_term", [](const Entry& entry) {
    read_text(entry);
    return entry.word({"fitted", "none"});
  });
  msm.has_volume_term = volume_term != "none";
}

/// One exponent for all springs, or one for each kind.
std::array<double, 3> read_exponent(const Entry& entry) {
  const std::string wanted = "a number, or three for edges, face and internal diagonals, from -20 to 20";
  const auto is_allowed = [](double p) { return -20 <= p && p <= 20; };
  if (entry.node && entry.node->is_array()) return Array<3>{wanted, is_allowed}(entry);
  const double p = Number{wanted, is_allowed}(entry);
  return {p, p, p};
}

bool has_exponent(SpringLaw law) {
  switch (law) {
  case SpringLaw::hooke:
    return false;
  case SpringLaw::power_log:
    break;
  }
  return true;
}

void read_law(Table& table, Msm& msm, const Case& definition) {
  const std::vector<Material> materials = materials_of(definition);
  const DesignLaw law = facts_of(msm.design).law;
  const bool is_fitted =
      is_isotropic(materials.front()) && (law == DesignLaw::fitted || law == DesignLaw::fitted_or_hooke);
  if (law == DesignLaw::power_log || law == DesignLaw::biquadratic || law == DesignLaw::by_spring) {
    table.refuse_unless(
        false, {"law", "exponent"},
        fmt::format("left out: design = \"{}\" has springs of a law of its own", name_of(msm.design)));
    return;
  }
  msm.law = table.optional("law", read_name<SpringLaw>);
  settle_law(msm, materials, has_nodal_forces(definition.loads));
  const SpringLaw own = law_of(msm, materials.front());
  table.refuse_unless(has_exponent(own), {"exponent"}, "left out: it belongs to law = \"power_log\"");
  if (own == SpringLaw::hooke) return;
  if (law == DesignLaw::hooke)
    table.entry("law").refuse(
        fmt::format("\"hooke\" with design = \"{}\", which fits springs of that law", name_of(msm.design)));
  if (!has_exponent(own)) return;
  if (is_fitted)
    msm.exponent = table.optional("exponent", read_exponent);
  else
    msm.exponent = read_exponent(table.entry("exponent"));
}

/// Reads given stiffnesses: for the kinds of springs, for the kinds along every axis, or one for all springs.
void read_stiffness(Table& table, Msm& msm) {
  table.know({"stiffness", "axis_stiffness"});
  if (msm.design == Design::uniform) {
    msm.uniform_stiffness =
        table.optional("stiffness", Number{"a number above 0 (N/m), of every spring", is_positive});
    return;
  }
  if (msm.design != Design::given) return;
  const bool is_by_axis = table.has("axis_stiffness");
  table.refuse_unless(!is_by_axis, {"stiffness"}, "left out beside axis_stiffness");
  const Entry entry = table.entry(is_by_axis ? "axis_stiffness" : "stiffness");
  const std::vector<double> k =
      is_by_axis ? Numbers{"seven numbers (N/m), none below 0: k_e along x, y, z, k_f in the faces across x, "
                           "y, z, and k_d",
                           7, is_not_negative}(entry)
                 : Numbers{"three numbers k_e, k_f, k_d (N/m), none below 0", 3, is_not_negative}(entry);
  if (std::none_of(k.begin(), k.end(), is_positive)) entry.refuse("stiffnesses of which one is above 0");
  if (is_by_axis)
    std::copy(k.begin(), k.end(), msm.axis_stiffness.emplace().begin());
  else
    msm.stiffness = {k[0], k[1], k[2]};
}

/// Checks that a design that is asked for suits the material. A default design is refused only when springs
/// are designed, which may never happen.
void check_is_for(const Entry& design, const Msm& msm, const Case& definition) {
  const Material& material = definition.material;
  if (!is_for(msm.design, is_isotropic(material)))
    design.refuse(
        fmt::format("{} with model = \"{}\"", designs_for(is_isotropic(material)), name_of(material)));
  const auto* fibrous = std::get_if<TransverselyIsotropic>(&material);
  if (msm.design == Design::transverse && !is_in_world(definition.body) && !axis_along(fibrous->fibre))
    design.refuse("\"given\" | \"network\" with this material.fibre, which lies along no axis of the grid");
}

/// Reads how often force scaling moves the points, where that is given.
void read_relaxation(Table& table, Msm& msm) {
  table.refuse_unless(msm.solver == Solver::force_scaling,
                      {"relaxation_steps", "relaxation_iterations", "further_iterations"},
                      "left out: it belongs to solver = \"force_scaling\"");
  constexpr int most = 1000000;
  const WholeNumber iterations{"a whole number from 0 to 1000000", 0, most};
  const auto load_steps = table.optional("relaxation_steps", up_to_1000),
             per_step = table.optional("relaxation_iterations", iterations),
             further = table.optional("further_iterations", iterations);
  if (!load_steps && !per_step && !further) return;
  const RelaxationCounts& counts = msm.relaxation.emplace(
      RelaxationCounts{load_steps.value_or(1), per_step.value_or(0), further.value_or(0)});
  if (counts.all() < 1 || counts.all() > most)
    refuse(table.where(),
           "relaxation_steps x relaxation_iterations + further_iterations is {}, must be from 1 to {}",
           counts.all(), most);
}

void check_real_time(Table& table, const Msm& msm, const Case& definition) {
  const Entry entry = table.entry("real_time");
  check_steps(entry, "msm", definition);
  if (msm.solver != Solver::newton) entry.refuse("left out beside another solver than \"newton\"");
  if (msm.iterations_per_step) entry.refuse("left out beside iterations_per_step");
  if (msm.mass == PointMass::consistent)
    entry.refuse("left out beside mass = \"consistent\": its masses are lumped");
  const StepMethod method = msm.real_time->method;
  if (msm.design == Design::biquadratic &&
      (method == StepMethod::xpbd || method == StepMethod::projective_dynamics))
    entry.refuse(fmt::format("of method = \"{}\" | \"{}\" | \"{}\" with design = \"biquadratic\", whose "
                             "tetrahedra are no constraints of one number",
                             name_of(StepMethod::vertex_block_descent), name_of(StepMethod::implicit_euler),
                             name_of(StepMethod::symplectic_euler)));
}

Msm read_msm(Table& table, const Case& definition) {
  const Material& material = definition.material;
  const Network* const network = std::get_if<Network>(&definition.body);
  Msm msm;
  msm.where = table.where();
  msm.poissons_ratio =
      table.optional("poissons_ratio", Number{"a number above -1 and below 0.5", is_poissons_ratio});
  const auto design = table.optional("design", read_name<Design>);
  if (network && design && *design != Design::network)
    table.entry("design").refuse("\"network\" or left out: the springs are those of body.springs");
  table.refuse_unless(!network, {"file", "mass"},
                      "left out: body.springs has the springs, and body.nodes the masses");
  msm.design = network  ? Design::network
               : design ? *design
                        : default_design(materials_of(definition), msm.poissons_ratio,
                                         has_nodal_forces(definition.loads));
  for (const std::string& key : keys_of_designs())
    table.refuse_unless(takes(msm.design, key), {key.c_str()},
                        "left out: it belongs to design = " + designs_with(key));
  if (table.has("design")) check_is_for(table.entry("design"), msm, definition);

  msm.solver = table.optional("solver", read_name<Solver>).value_or(Solver::newton);
  read_relaxation(table, msm);
  msm.split =
      table.optional("split", Number{"a number from 0 to 1", [](double t) { return t >= 0 && t <= 1; }});
  msm.beta =
      table.optional("beta", Number{"a number above 0, at most 2", [](double b) { return b > 0 && b <= 2; }});
  read_stiffness(table, msm);
  table.know({"file"});
  if (network)
    msm.network = network->springs;
  else if (msm.design == Design::network)
    msm.network = read_file_name(table.entry("file"), {".csv"}, "a file of springs, .csv", definition.file);
  msm.volume_stiffness =
      table.optional("volume_stiffness", Number{"a number, 0 or above (MPa)", is_not_negative}).value_or(0);
  msm.has_auto_design =
      !design && !msm.beta && !table.has("law") && !table.has("exponent") && !table.has("strain_range");
  read_law(table, msm, definition);
  read_fit(table, msm);
  table.refuse_unless(definition.dynamics || definition.material_dynamics.density, {"mass"}, has_no_mass);
  msm.mass = table.optional("mass", read_name<PointMass>).value_or(msm.mass);
  if (msm.mass == PointMass::consistent && msm.network)
    table.entry("mass").refuse(
        "\"cells\" | \"uniform\" beside design = \"network\": its springs belong to no cell");
  table.refuse_unless(definition.dynamics.has_value(), {"iterations_per_step"},
                      "left out without [dynamics]");
  msm.iterations_per_step = table.optional("iterations_per_step", up_to_1000);
  msm.real_time =
      table.section_if_there("real_time", [&](Table& section) { return read_steps(section, definition); });
  if (msm.real_time) check_real_time(table, msm, definition);
  msm.accepted = table.optional("accept", read_names<Doubt>).value_or(std::vector<Doubt>{});
  const std::string needed = design_needed(msm, material);
  if (!needed.empty()) table.entry("design").refuse(needed);
  return msm;
}

/// Checks the materials of regions against the element and the design.
void check_region_materials(const Case& definition) {
  for (const RegionMaterial& region : definition.region_materials) {
    if (facts_of(definition.msm.design).source == DesignSource::file)
      refuse(region.where,
             "must be left out beside msm.design = \"{}\", which gives one set of springs for all cells",
             name_of(definition.msm.design));
    const std::string element = element_needed(definition.fem.element, region.material),
                      design = design_needed(definition.msm, region.material);
    if (!element.empty()) throw InputError(region.where, "the element must be " + element);
    if (!design.empty()) throw InputError(region.where, "the springs' design must be " + design);
  }
}

} // namespace

Design default_design(const std::vector<Material>& materials, std::optional<double> poissons_ratio,
                      bool has_nodal_forces) {
  if (!is_isotropic(materials.front())) return Design::transverse;
  bool is_hybrid = false;
  for (const Material& material : materials) {
    if (!is_isotropic(material)) continue; // refused where springs are designed
    const double nu = poissons_ratio.value_or(poissons_ratio_of(material));
    if (nu < 0) return Design::moduli;
    // 0.36 loses its stability at a logarithmic strain of -0.2; below 0.25 the volume term is negative.
    is_hybrid = is_hybrid || nu < 0.25 || (nu > 0.35 && !is_hyperelastic(material));
  }
  if (!has_nodal_forces) return Design::midline;
  return is_hybrid ? Design::hybrid : Design::matched;
}

void read_models(Table& root, Case& result) {
  result.fem = root.optional_section("fem", [&](Table& table) { return read_fem(table, result); });
  result.msm = root.optional_section("msm", [&](Table& table) { return read_msm(table, result); });
  check_region_materials(result);
}

} // namespace springproof::cases
