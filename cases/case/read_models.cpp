#include "cases/case/read_models.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace springproof::cases {

namespace {

bool is_poissons_ratio(double value) {
  return value > -1 && value < 0.5;
}

/// Refuses a key that has no meaning beside the others.
void refuse_unless(bool has_meaning, Table& table, const std::string& key, const std::string& reason) {
  if (table.has(key) && !has_meaning) table.entry(key).refuse("left out: " + reason);
}

/// One line per formulation: the elements it has, its default first. The pressure of a mixed or averaged
/// element acts on the volume ratio J; the law S = lambda tr(E) I + 2 mu E has no such part, so there is
/// nothing to average in it.
const std::vector<std::pair<Formulation, std::vector<Element>>>& elements_of_formulations() {
  using E = Element;
  static const std::vector<std::pair<Formulation, std::vector<Element>>> table{
      {Formulation::small_strain, {E::q1_bbar, E::q1, E::q1_p0, E::q2, E::q2_p1}},
      {Formulation::saint_venant_kirchhoff, {E::q1, E::q2}},
      {Formulation::log_strain, {E::q1_bbar, E::q1, E::q1_p0, E::q2, E::q2_p1}},
      {Formulation::hyperelastic, {E::q1_p0, E::q1_bbar, E::q1, E::q2, E::q2_p1}}};
  return table;
}

const std::vector<Element>& elements_of(Formulation formulation) {
  const auto& table = elements_of_formulations();
  return std::find_if(table.begin(), table.end(), [&](const auto& line) { return line.first == formulation; })
      ->second;
}

/// A key whose only word is "auto".
bool read_auto(const Entry& entry) {
  if (!entry.node || entry.node->value_exact<std::string>() != "auto") entry.refuse_word({"auto"});
  return true;
}

bool is_auto(Table& table, const std::string& key) {
  return table.has(key) && table.entry(key).node->value_exact<std::string>() == "auto";
}

Formulation read_formulation_name(const Entry& entry) {
  const auto text = entry.node ? entry.node->value_exact<std::string>() : std::nullopt;
  const auto formulation = text ? value_of<Formulation>(*text) : std::nullopt;
  std::vector<std::string> allowed = all_names<Formulation>();
  allowed.emplace_back("auto");
  if (!formulation) entry.refuse_word(allowed);
  return *formulation;
}

/// "auto" falls back on the default.
Formulation read_formulation(Table& table, const Material& material) {
  const bool is_ogden = std::holds_alternative<Ogden>(material);
  if (is_auto(table, "formulation")) {
    if (is_ogden)
      table.entry("formulation")
          .refuse("\"hyperelastic\" with the ogden material, which has no small strains");
    return Formulation::log_strain;
  }
  const auto formulation = table.optional("formulation", read_formulation_name);
  if (!formulation) return is_ogden ? Formulation::hyperelastic : Formulation::log_strain;
  const bool needs_ogden = *formulation == Formulation::hyperelastic;
  if (needs_ogden && !is_ogden)
    table.entry("formulation")
        .refuse("\"small_strain\" | \"saint_venant_kirchhoff\" | \"log_strain\" with the linear_elastic "
                "material; "
                "hyperelastic needs model = \"ogden\"");
  if (!needs_ogden && is_ogden)
    table.entry("formulation")
        .refuse("\"hyperelastic\" with the ogden material; the others need model = \"linear_elastic\"");
  return *formulation;
}

/// The elements required by the material, when this one is not among them.
std::optional<std::string> element_needed(Element element, const Material& material) {
  const Ogden* ogden = std::get_if<Ogden>(&material);
  if (ogden && !ogden->bulk_modulus && (element == Element::q1 || element == Element::q2))
    return "\"q1_p0\" | \"q1_bbar\" | \"q2_p1\" with an ogden material that has no bulk_modulus: it is "
           "nearly incompressible, and a displacement element without averaged volume locks";
  return std::nullopt;
}

Element read_element(Table& table, Formulation formulation, const Material& material) {
  const std::vector<Element>& allowed = elements_of(formulation);
  const Element element = table.optional("element", read_name<Element>).value_or(allowed.front());
  if (std::find(allowed.begin(), allowed.end(), element) == allowed.end()) {
    std::vector<std::string> words;
    for (const Element e : allowed) words.push_back(name_of(e));
    table.entry("element").refuse(
        fmt::format("{} with formulation = \"{}\"", alternatives(words), name_of(formulation)));
  }
  if (const auto needed = element_needed(element, material)) table.entry("element").refuse(*needed);
  return element;
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

} // namespace

Fem read_fem(Table& table, const Material& material, const Body& body) {
  Fem fem;
  fem.where = table.where();
  fem.formulation = read_formulation(table, material);
  fem.has_auto_formulation = is_auto(table, "formulation");
  fem.element = read_element(table, fem.formulation, material);
  if (const auto refine = table.optional("refine", WholeNumber{"a whole number from 0 to 8", 0, 8})) {
    fem.refine = *refine;
    check_refined_size(table.entry("refine"), body, fem.refine);
  }
  fem.has_auto_accuracy = table.optional("accuracy", read_auto).value_or(false);
  refuse_unless(!fem.has_auto_accuracy, table, "refine", "accuracy = \"auto\" finds it");
  return fem;
}

void check_accuracy(Table& root, const Case& definition) {
  if (!definition.fem.has_auto_accuracy && !definition.fem.has_auto_formulation) return;
  const auto asks_of_fem = [](const Expectation& e) { return e.quantity != Quantity::msm; };
  if (std::none_of(definition.expectations.begin(), definition.expectations.end(), asks_of_fem))
    root.entry("expect").refuse(
        "one or more tables [[expect]] with error_percent or fem: \"auto\" in [fem] is as accurate "
        "as they ask for");
}

void check_element(const Fem& fem, const Material& material, const Where& where) {
  if (const auto needed = element_needed(fem.element, material))
    throw InputError(where, "the element must be " + *needed);
}

namespace {

void check_given_stiffness(const Entry& entry, const std::array<double, 3>& stiffness) {
  if (!(stiffness[0] > 0 || stiffness[1] > 0 || stiffness[2] > 0))
    entry.refuse("stiffnesses of which one is above 0");
}

/// The requirement of the design on Poisson's ratio, when it is not met.
std::optional<std::string> design_needed(const Msm& msm, const Material& material) {
  const LinearElastic* linear = std::get_if<LinearElastic>(&material);
  const Ogden* ogden = std::get_if<Ogden>(&material);
  const bool is_incompressible = ogden && !ogden->bulk_modulus && !msm.poissons_ratio;
  if (msm.design == Design::linear_method && is_incompressible)
    return "another design than \"linear_method\", which needs a Poisson's ratio below 0.5: this ogden "
           "material has none without bulk_modulus; or give msm.poissons_ratio";
  const std::optional<double> ratio = msm.poissons_ratio ? msm.poissons_ratio
                                      : linear           ? std::optional(linear->poissons_ratio)
                                                         : std::nullopt;
  if (msm.design == Design::hybrid && ratio && *ratio < 0.25)
    return fmt::format("another design than \"hybrid\", which needs a Poisson's ratio of 0.25 and more: "
                       "at {} its volume stiffness would be negative",
                       *ratio);
  return std::nullopt;
}

std::vector<LoadPath> read_paths(const Entry& entry) {
  std::vector<LoadPath> paths;
  for (const Entry& element : entry.elements(alternatives(all_names<LoadPath>()))) {
    paths.push_back(read_name<LoadPath>(element));
    if (std::count(paths.begin(), paths.end(), paths.back()) > 1)
      element.refuse("a path that is not in the list yet");
  }
  if (paths.empty()) entry.refuse("one path or more of " + alternatives(all_names<LoadPath>()));
  return paths;
}

/// What the designs that are fitted to curves are fitted to.
void read_fit(Table& table, Msm& msm) {
  msm.paths = table.optional("paths", read_paths).value_or(std::vector<LoadPath>{});
  const std::size_t n_paths = msm.paths.empty() ? all_names<LoadPath>().size() : msm.paths.size();
  const std::string per_path = fmt::format("{} numbers, none below 0 and not all 0: one per path", n_paths);
  if (const auto weights = table.optional("weights", Numbers{per_path, n_paths, is_not_negative})) {
    if (std::all_of(weights->begin(), weights->end(), [](double w) { return w == 0; }))
      table.entry("weights").refuse(per_path);
    msm.weights = *weights;
  }
  if (const auto range =
          table.optional("strain_range", Numbers{"two numbers from -2 to 2, the smaller first", 2,
                                                 [](double e) { return e >= -2 && e <= 2; }})) {
    if (!((*range)[0] < (*range)[1]))
      table.entry("strain_range").refuse("two numbers from -2 to 2, the smaller first");
    msm.strain_range = {(*range)[0], (*range)[1]};
  }
  const auto volume_term = table.optional("volume_term", [](const Entry& entry) {
    const std::string word = read_text(entry);
    if (word != "fitted" && word != "none") entry.refuse_word({"fitted", "none"});
    return word;
  });
  msm.has_volume_term = volume_term.value_or("fitted") == "fitted";
}

} // namespace

Msm read_msm(Table& table, const Material& material) {
  Msm msm;
  msm.where = table.where();
  msm.design = table.optional("design", read_name<Design>)
                   .value_or(std::holds_alternative<Ogden>(material) ? Design::nonlinear_method
                                                                     : Design::linear_method);
  const bool is_given = msm.design == Design::given;
  const bool is_multi_load = msm.design == Design::multi_load;
  const bool has_split = msm.design == Design::moduli || msm.design == Design::hybrid || is_multi_load;
  const std::string belongs = " belongs to design = ";
  refuse_unless(!is_given, table, "poissons_ratio",
                "a given stiffness is not designed from a Poisson's ratio");
  refuse_unless(has_split, table, "split", "it" + belongs + "\"moduli\" | \"hybrid\" | \"multi_load\"");
  for (const char* key : {"paths", "weights", "volume_term"})
    refuse_unless(is_multi_load, table, key, "it" + belongs + "\"multi_load\"");
  refuse_unless(is_multi_load || msm.design == Design::nonlinear_method, table, "strain_range",
                "it" + belongs + "\"multi_load\" | \"nonlinear_method\"");
  refuse_unless(is_given, table, "stiffness", "it" + belongs + "\"given\"");
  refuse_unless(is_given, table, "volume_stiffness", "it" + belongs + "\"given\"");

  msm.solver = table.optional("solver", read_name<Solver>).value_or(Solver::newton);
  msm.poissons_ratio =
      table.optional("poissons_ratio", Number{"a number above -1 and below 0.5", is_poissons_ratio});
  msm.split =
      table.optional("split", Number{"a number from 0 to 1", [](double t) { return t >= 0 && t <= 1; }});
  if (is_given) {
    const Entry entry = table.entry("stiffness");
    const auto k = Numbers{"three numbers k_e, k_f, k_d (N/m), none below 0", 3, is_not_negative}(entry);
    msm.stiffness = {k[0], k[1], k[2]};
    check_given_stiffness(entry, *msm.stiffness);
  } else {
    table.optional("stiffness", read_text); // known, though absent
  }
  msm.volume_stiffness =
      table.optional("volume_stiffness", Number{"a number, 0 or above (MPa)", is_not_negative}).value_or(0);
  read_fit(table, msm);
  if (const auto needed = design_needed(msm, material)) table.entry("design").refuse(*needed);
  return msm;
}

void check_design_ratio(const Msm& msm, const Material& material, const Where& where) {
  if (const auto needed = design_needed(msm, material))
    throw InputError(where, "the springs' design must be " + *needed);
}

} // namespace springproof::cases
