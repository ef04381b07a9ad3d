#include "compare/client/methods.hpp"

#include "cases/case/elements.hpp"
#include "cases/case/error.hpp"
#include "cases/case/input_file.hpp"
#include "compare/provenance/print.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <utility>

namespace springproof::compare {

namespace {

const std::string of_elements = "fem.";

/// What steps in time with lumped masses ignore of a case, which then has it no more.
std::vector<std::string> leave_to_steps(cases::Case& definition) {
  using cases::Scheme;
  std::vector<std::string> ignored;
  if (definition.dynamics) {
    Scheme& scheme = definition.dynamics->scheme.scheme;
    if (scheme != Scheme::implicit_euler) ignored.push_back("scheme " + cases::name_of(scheme));
    scheme = Scheme::implicit_euler;
  }
  double damping = std::exchange(definition.material_dynamics.stiffness_damping, 0);
  for (cases::RegionMaterial& region : definition.region_materials)
    damping += std::exchange(region.dynamics.stiffness_damping, 0);
  if (damping > 0) ignored.emplace_back("stiffness_damping");
  if (cases::has_memory(definition)) ignored.emplace_back("prony");
  definition.material_dynamics.prony.clear();
  for (cases::RegionMaterial& region : definition.region_materials) region.dynamics.prony.clear();
  return ignored;
}

/// Notes masses that are not lumped, which a body at rest does not tell.
template<class Mass>
void lump(Mass& mass, Mass lumped, const cases::Case& definition, std::vector<std::string>& ignored) {
  if (mass == Mass::consistent && definition.dynamics) ignored.emplace_back("masses that are not lumped");
  if (mass == Mass::consistent) mass = lumped;
}

} // namespace

std::string name_of(const AnyMethod& method) {
  const auto* const of_springs = std::get_if<cases::StepMethod>(&method);
  return of_springs ? cases::name_of(*of_springs)
                    : of_elements + cases::name_of(std::get<cases::ElementMethod>(method));
}

std::optional<AnyMethod> method_called(const std::string& name) {
  if (const auto method = cases::value_of<cases::StepMethod>(name)) return *method;
  if (name.rfind(of_elements, 0) != 0) return std::nullopt;
  const auto method = cases::value_of<cases::ElementMethod>(name.substr(of_elements.size()));
  return method ? std::optional<AnyMethod>(*method) : std::nullopt;
}

std::vector<std::string> method_names() {
  std::vector<std::string> names = cases::all_names<cases::StepMethod>();
  for (const std::string& name : cases::all_names<cases::ElementMethod>())
    names.push_back(of_elements + name);
  return names;
}

AnyMethod method_of(const Steps& steps) {
  return std::visit([](const auto& by) -> AnyMethod { return by.method; }, steps);
}

std::string text_of(const Steps& steps) {
  const bool is_of_elements = std::holds_alternative<cases::ElementRealTime>(steps);
  return (is_of_elements ? of_elements : "") +
         std::visit([](const auto& by) { return cases::text_of(by, by.substeps); }, steps);
}

Steps steps_in(const AnyMethod& method, const ClientBudget& budget) {
  const auto by = [&](auto of) -> Steps {
    cases::StepsBy<decltype(of)> steps;
    steps.method = of;
    if (budget.iterations > 0) steps.iterations = budget.iterations;
    steps.step = budget.step;
    steps.end = budget.model_time;
    return steps;
  };
  return std::visit(by, method);
}

Json settings_of(const Steps& steps, const cases::Case& definition) {
  return std::visit(
      [&](const auto& by) {
        Json settings{{"iterations", by.iterations}, {"substeps", by.substeps}};
        if (cases::is_explicit(by.method)) settings.erase("iterations");
        if (!definition.dynamics) settings.update({{"step", by.step}, {"damping", by.damping}});
        if constexpr (std::is_same_v<std::decay_t<decltype(by)>, cases::ElementRealTime>)
          settings["element"] = cases::name_of(definition.fem.element);
        return settings;
      },
      steps);
}

std::vector<std::string> set_steps(cases::Case& definition, const cases::RealTime& real_time) {
  definition.msm.real_time = real_time;
  definition.msm.solver = cases::Solver::newton;
  definition.msm.iterations_per_step.reset();
  definition.msm.relaxation.reset();
  std::vector<std::string> ignored;
  lump(definition.msm.mass, cases::PointMass::cells, definition, ignored);
  const std::vector<std::string> others = leave_to_steps(definition);
  ignored.insert(ignored.end(), others.begin(), others.end());
  return ignored;
}

std::vector<std::string> set_steps(cases::Scene& scene, const cases::ElementRealTime& real_time) {
  cases::Case& definition = scene.definition;
  cases::Fem& fem = definition.fem;
  const auto refuse = [&](const std::string& needed) {
    throw cases::InputError(
        fmt::format("{}{} cannot step the case: {}", of_elements, cases::name_of(real_time.method), needed));
  };
  if (definition.fem_body) refuse("[fem.body] must be left out");
  for (const cases::Material& material : cases::materials_of(definition))
    if (const std::string needed = cases::steps_needed(real_time.method, material); !needed.empty())
      refuse("it must be " + needed);
  for (const cases::Measure& measure : definition.measures)
    if (cases::is_of_fields(measure.kind))
      refuse(fmt::format("measure {} must be of the displacement: steps leave forces that are in no balance",
                         measure.name));
  fem.real_time = real_time;
  const bool is_tetrahedron = scene.mesh.shape == cases::CellShape::tetrahedron;
  const std::vector<cases::Element> taken = cases::elements_of(fem, is_tetrahedron);
  if (taken.empty()) refuse("the body must be a mesh of tetrahedra");
  if (std::find(taken.begin(), taken.end(), fem.element) == taken.end()) fem.element = taken.front();
  std::vector<std::string> ignored;
  if (std::exchange(fem.refine, 0) > 0) ignored.emplace_back("fem.refine");
  if (!cases::has_law_of_case(real_time.method)) ignored.push_back("fem.formulation, for a law of its own");
  lump(fem.mass, cases::ElementMass::lumped, definition, ignored);
  const std::vector<std::string> others = leave_to_steps(definition);
  ignored.insert(ignored.end(), others.begin(), others.end());
  return ignored;
}

NamedMethod method_of(const std::string& argument, const ClientBudget& budget) {
  const auto refuse = [&](const std::string& reason) -> cases::InputError {
    return cases::InputError(fmt::format("--method: {} {}; give NAME, NAME:ITERATIONS, "
                                         "NAME:ITERATIONS:SUBSTEPS or NAME::SUBSTEPS",
                                         one_line(argument), reason));
  };
  std::vector<std::string> parts(1);
  for (const char c : argument) c == ':' ? void(parts.emplace_back()) : parts.back().push_back(c);
  const auto method = method_called(parts.front());
  if (!method)
    throw refuse(fmt::format("names no method of [msm] real_time or, behind \"{}\", of [fem] real_time: {}",
                             of_elements, fmt::join(method_names(), ", ")));
  NamedMethod named{argument, steps_in(*method, budget)};
  const auto number = [&](const std::string& text, const char* what, int most) {
    const auto value = cases::number_in<int>(text);
    if (!value || *value < 1 || *value > most)
      throw refuse(fmt::format("has \"{}\" {}, may have 1 to {}", one_line(text), what, most));
    return *value;
  };
  if (parts.size() > 3) throw refuse("has more than two numbers");
  const bool has_iterations = parts.size() > 1 && !(parts.size() == 3 && parts[1].empty());
  std::visit(
      [&](auto& steps) {
        if (has_iterations && cases::is_explicit(steps.method))
          throw refuse("is explicit and has no iterations");
        if (has_iterations) steps.iterations = number(parts[1], "iterations", 100000);
        if (parts.size() > 2) steps.substeps = number(parts[2], "substeps", 1000);
      },
      named.steps);
  return named;
}

} // namespace springproof::compare
