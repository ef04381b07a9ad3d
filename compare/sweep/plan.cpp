#include "compare/sweep/sweep.hpp"

#include "cases/case/elements.hpp"
#include "cases/case/error.hpp"
#include "cases/case/names.hpp"
#include "cases/scene/scene.hpp"
#include "compare/provenance/print.hpp"
#include "compare/solve/progress.hpp"
#include "compare/table/table.hpp"
#include "msm/design/design.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <numeric>

namespace springproof::compare {

namespace {

using cases::Element;
using cases::Formulation;

constexpr std::array<Element, 4> elements{Element::q1, Element::q1_bbar, Element::q1_wilson, Element::q2};
constexpr double tight = 1e-9;
constexpr std::array<double, 3> tolerances{1e-2, 1e-4, tight};

/// Unknowns of a displacement element on a box, held ones included.
long n_unknowns(const std::array<int, 3>& cells, Element element) {
  const int degree = cases::facts_of(element).degree;
  long n = 3;
  for (const int c : cells) n *= degree * c + 1;
  return n;
}

/// Unknowns above which a solve takes so long that the four cases of cases/sweep would not be swept in ten
/// minutes.
struct Limits {
  long loose; ///< finite elements of other tolerances than the tight one
  long tight;
  long calculix; ///< which factorises with SPOOLES
  long lattice;  ///< springs of cells that are assembled and factorised, and designs of others
};
constexpr Limits size_limits{60000, 400000, 10000, 30000};

void leave_out(std::vector<LeftOut>& left_out, const std::string& what, long size, long limit) {
  left_out.push_back({what, fmt::format("{} unknowns, above the limit of {}", size, limit)});
}

void add_springs(Plan& plan, Extent extent) {
  for (const SweptSprings& springs :
       springs_to_sweep(cases::LinearElastic{}, plan.levels, extent, plan.left_out))
    for (const double tolerance : tolerances)
      if (springs.settings == Settings::all || tolerance == tight)
        plan.variants.push_back({Program::springs, springs.design, {}, {}, springs.cells, tolerance});
}

void add_finite_elements(Plan& plan, Formulation formulation, Element element, Extent extent) {
  const bool is_linear = formulation == Formulation::small_strain;
  for (const auto& cells : plan.levels) {
    const long size = n_unknowns(cells, element);
    const bool is_planned = // as a mesh of the reference
        std::any_of(plan.reference.begin(), plan.reference.end(), [&](const Variant& v) {
          return v.formulation == formulation && v.element == element && v.cells == cells;
        });
    if (is_planned && size > size_limits.loose) continue;
    const std::string name =
        cases::name_of(formulation) + " " + cases::name_of(element) + " " + cells_name(cells);
    if (size > size_limits.tight) {
      leave_out(plan.left_out, name, size, size_limits.tight);
      continue;
    }
    for (const double tolerance : tolerances) {
      const bool is_loose = tolerance != tight;
      if (is_loose && (is_linear || extent == Extent::quick || size > size_limits.loose)) continue;
      if (!is_loose && is_planned) continue;
      plan.variants.push_back({Program::finite_elements, {}, formulation, element, cells, tolerance});
    }
    if (!is_linear && extent == Extent::full && size > size_limits.loose)
      leave_out(plan.left_out, name + " at looser tolerances", size, size_limits.loose);
  }
}

void add_calculix(Plan& plan) {
  for (const Formulation formulation : {Formulation::small_strain, Formulation::saint_venant_kirchhoff})
    for (const auto& cells : plan.levels) {
      const Variant variant{Program::calculix, {}, formulation, Element::q1, cells, tight};
      const long size = n_unknowns(cells, Element::q1);
      if (size <= size_limits.calculix)
        plan.variants.push_back(variant);
      else
        leave_out(plan.left_out, method_name(variant) + " " + cells_name(cells), size, size_limits.calculix);
    }
}

constexpr double process_seconds = 0.5; ///< to start a process, and to read and send
constexpr double seconds_in_this_process = 0.01;
constexpr double again_part = 0.7; ///< part of the first solve's time that a re-solve takes

double total(const std::vector<double>& seconds) {
  return std::accumulate(seconds.begin(), seconds.end(), 0.);
}

} // namespace

std::vector<std::array<int, 3>> levels_of(const cases::Case& definition, Extent extent) {
  const auto* box = std::get_if<cases::Box>(&definition.body);
  if (!box)
    throw cases::InputError(
        definition.file +
        ": body.shape: a sweep divides the body anew, which must be \"box\"; `run --converge` "
        "refines any mesh, and `run --designs all` ranks springs on it");
  std::array<int, 3> cells = box->cells;
  if (std::all_of(cells.begin(), cells.end(), [](int n) { return n % 2 == 0; }))
    for (int& n : cells) n /= 2;
  std::vector<std::array<int, 3>> levels;
  for (int level = 0; level < (extent == Extent::quick ? 3 : 4); ++level) {
    levels.push_back(cells);
    for (int& n : cells) n *= 2;
  }
  return levels;
}

std::vector<SweptSprings> springs_to_sweep(const cases::Material& material,
                                           const std::vector<std::array<int, 3>>& levels, Extent extent,
                                           std::vector<LeftOut>& left_out) {
  std::vector<SweptSprings> all;
  for (const cases::Design design : msm::methods(material))
    for (const auto& cells : levels) {
      const bool is_of_others = cases::is_of_others(design);
      const long size = n_unknowns(cells, Element::q1);
      if (is_of_others && size > size_limits.lattice)
        leave_out(left_out, "springs " + cases::name_of(design) + " " + cells_name(cells), size,
                  size_limits.lattice);
      else
        all.push_back(
            {design, cells, extent == Extent::full && !is_of_others ? Settings::all : Settings::one});
    }
  return all;
}

Family family_of(const Variant& variant) {
  return variant.program == Program::springs ? Family::springs : Family::finite_elements;
}

std::string model_name(const Variant& variant) {
  return variant.program == Program::springs ? "springs " + cases::name_of(variant.design)
                                             : cases::name_of(variant.element) + " elements";
}

std::string method_name(const Variant& variant) {
  if (variant.real_time)
    return fmt::format("{}, {}", model_name(variant), name_of(method_of(*variant.real_time)));
  if (variant.program == Program::springs) return "springs " + cases::name_of(variant.design);
  const std::string name = cases::name_of(variant.formulation) + " " + cases::name_of(variant.element);
  return variant.program == Program::calculix ? "CalculiX " + name : name;
}

std::string cells_name(const std::array<int, 3>& cells) {
  return fmt::format("{}x{}x{}", cells[0], cells[1], cells[2]);
}

std::array<int, 3> field_cells(const Variant& variant) {
  std::array<int, 3> cells = variant.cells;
  if (variant.program == Program::finite_elements && variant.element == cases::Element::q2)
    for (int& n : cells) n *= 2;
  return cells;
}

std::string full_name(const Variant& variant) {
  if (const auto& steps = variant.real_time; steps || variant.tolerance == 0) {
    std::string name = model_name(variant);
    if (variant.cells[0] > 0) name += fmt::format(", {} cells", cells_name(variant.cells));
    return steps ? name + ", " + text_of(*steps) : name;
  }
  if (variant.step > 0)
    return fmt::format("{}, {} cells, steps of {:g} ms", method_name(variant), cells_name(variant.cells),
                       1e3 * variant.step);
  const std::string name = method_name(variant) + " " + cells_name(variant.cells);
  if (variant.program == Program::calculix) return name;
  return name + fmt::format(" to {:.0e}", variant.tolerance);
}

cases::Case with_variant(const cases::Case& definition, const Variant& variant) {
  cases::Case result = definition;
  std::get<cases::Box>(result.body).cells = variant.cells;
  result.measures.clear();
  result.expectations.clear();
  result.fem.refine = 0;
  if (variant.program == Program::springs) {
    result.msm = {};
    result.msm.design = variant.design;
    result.msm.where = definition.msm.where;
  } else {
    result.fem.formulation = variant.formulation;
    result.fem.element = variant.element;
  }
  return result;
}

Plan plan_sweep(const cases::Case& definition, Extent extent) {
  Plan plan;
  plan.levels = levels_of(definition, extent);
  const auto refuse_if = [&](bool is_there, const std::string& why) {
    if (is_there) throw cases::InputError(definition.file + ": " + why);
  };
  refuse_if(!std::holds_alternative<cases::LinearElastic>(definition.material),
            "material.model: a sweep has small strain too, so it must be \"linear_elastic\"");
  cases::refuse_tools(definition, "a sweep", "its displacements are interpolated between grids");
  refuse_if(definition.dynamics.has_value(), "dynamics: a sweep is of equilibria, so it must be left out");
  refuse_if(definition.msm.exponent.has_value(),
            "msm.law: a sweep solves every design with the springs that are its own, so it must be left out");
  if (const auto joined = cases::first_joined(definition))
    throw cases::InputError(
        joined->where, "is joined, must be left out of a sweep: its sides end elsewhere on other meshes");
  if (definition.msm.relaxation)
    throw cases::InputError(definition.msm.where,
                            "relaxation_steps, relaxation_iterations and further_iterations must "
                            "be left out of a sweep, which is of equilibria");
  for (const auto& [has_steps, where] :
       {std::pair{definition.msm.real_time.has_value(), definition.msm.where},
        std::pair{definition.fem.real_time.has_value(), definition.fem.where}})
    if (has_steps) throw cases::InputError(where, "real_time must be left out of a sweep of equilibria");
  for (const cases::Measure& measure : definition.measures)
    if (cases::is_of_fields(measure.kind))
      throw cases::InputError(measure.where,
                              fmt::format("kind is \"{}\", must be one of the displacement: a sweep "
                                          "compares displacements interpolated between grids",
                                          cases::name_of(measure.kind)));
  for (std::size_t level = plan.levels.size() - 3; level < plan.levels.size(); ++level)
    plan.reference.push_back(
        {Program::finite_elements, {}, Formulation::log_strain, Element::q2, plan.levels[level], tight});
  plan.variants = plan.reference;
  add_springs(plan, extent);
  for (const Formulation formulation : {Formulation::small_strain, Formulation::log_strain})
    for (const Element element : elements) add_finite_elements(plan, formulation, element, extent);
  if (extent == Extent::full) add_calculix(plan);
  if (extent == Extent::quick)
    plan.left_out.push_back(
        {"CalculiX, the finest level and the looser tolerances", "--quick was asked for"});
  return plan;
}

Estimate estimate_of(const Sweep& sweep, const Variant& variant) {
  const BodySize body = size_of(with_variant(sweep.definition, variant)).value(); // a box
  Estimate model = variant.program == Program::springs ? estimate_springs(body) : estimate_fem(body);
  const int n = n_repetitions(model.seconds, sweep.rules);
  const double rounds = n == 0 ? 1 : (1 + n) * (1 + again_part); // a first one to warm up
  const bool has_process = sweep.processes == Processes::one_per_variant;
  model.seconds = (has_process ? process_seconds : seconds_in_this_process) + rounds * model.seconds;
  return model;
}

std::vector<double> estimated_seconds(const Sweep& sweep) {
  std::vector<double> seconds;
  for (const Variant& variant : sweep.plan.variants) seconds.push_back(estimate_of(sweep, variant).seconds);
  return seconds;
}

void cut_to_budget(Sweep& sweep, double budget_seconds) {
  std::vector<double> seconds = estimated_seconds(sweep);
  std::vector<Variant>& variants = sweep.plan.variants;
  const auto first =
      static_cast<std::ptrdiff_t>(sweep.plan.reference.size()); // which comes before the others
  double all = total(seconds);
  while (all > budget_seconds && seconds.size() > sweep.plan.reference.size()) {
    const auto longest = std::max_element(seconds.begin() + first, seconds.end());
    const auto variant = variants.begin() + (longest - seconds.begin());
    sweep.plan.left_out.push_back(
        {full_name(*variant), fmt::format("its estimated {:.2g} s do not fit into the budget of {:g} s",
                                          *longest, budget_seconds)});
    all -= *longest;
    variants.erase(variant);
    seconds.erase(longest);
  }
}

void check_memory(const Sweep& sweep) {
  const MemoryLimit limit = memory_limit();
  for (const Variant& variant : sweep.plan.variants)
    check_memory(sweep.definition.file + ", " + full_name(variant), {estimate_of(sweep, variant)}, limit);
}

void write_plan(std::ostream& out, const Sweep& sweep) {
  print(out, "{}: {} variants, about {} in all (minutes:seconds)\n", sweep.definition.name,
        sweep.plan.variants.size(), clock_text(total(estimated_seconds(sweep))));
  struct Method {
    std::string method;
    int variants = 0;
    double unknowns = 0, megabytes = 0, seconds = 0; ///< the largest variant's; seconds of all
  };
  std::vector<Method> methods;
  for (const Variant& variant : sweep.plan.variants) {
    const std::string name = method_name(variant);
    const auto found =
        std::find_if(methods.begin(), methods.end(), [&](const Method& m) { return m.method == name; });
    Method& method = found == methods.end() ? methods.emplace_back(Method{name}) : *found;
    const Estimate estimate = estimate_of(sweep, variant);
    ++method.variants;
    method.unknowns = std::max(method.unknowns, estimate.unknowns);
    method.megabytes = std::max(method.megabytes, estimate.megabytes);
    method.seconds += estimate.seconds;
  }
  write_table(out, columns_of("method variants unknowns~up~to=unknowns{:.0f} MB=megabytes{:.0f} time"),
              json_list(methods, [](const Method& m) {
                Json row = SPRINGPROOF_MEMBERS(m, method, variants, unknowns, megabytes);
                row["time"] = clock_text(m.seconds);
                return row;
              }));
  for (const LeftOut& left : sweep.plan.left_out) print(out, "  left out: {}: {}\n", left.what, left.reason);
}

} // namespace springproof::compare
