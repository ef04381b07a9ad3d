#include "cases/case/readers.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace springproof::cases {

namespace {

const std::string is_static = "left out without [dynamics]: a static case has no time";

TimeScheme read_scheme(Table& table) {
  TimeScheme result;
  result.scheme = table.required("scheme", read_name<Scheme>);
  const bool is_newmark = result.scheme == Scheme::newmark,
             is_alpha = result.scheme == Scheme::generalized_alpha;
  table.refuse_unless(is_newmark, {"beta", "gamma"}, "left out: it belongs to scheme = \"newmark\"");
  table.refuse_unless(is_alpha, {"rho_infinity"}, "left out: it belongs to scheme = \"generalized_alpha\"");
  const auto is_order = [](double gamma) { return gamma >= 0.5 && gamma <= 1; };
  result.gamma = table.optional("gamma", Number{"a number from 0.5 to 1", is_order}).value_or(0.5);
  const std::string stable =
      fmt::format("a number from gamma/2, which is {}, to 1: smaller ones are unstable with long steps",
                  result.gamma / 2);
  const auto is_stable = [&](double beta) { return 2 * beta >= result.gamma && beta <= 1; };
  result.beta = table.optional("beta", Number{stable, is_stable})
                    .value_or(std::pow(result.gamma + 0.5, 2) / 4); // damps the fastest motion most
  const auto is_ratio = [](double rho) { return rho >= 0 && rho <= 1; };
  if (is_alpha)
    result.rho_infinity = table.required(
        "rho_infinity", Number{"a number from 0 to 1: what a step leaves of the fastest motion", is_ratio});
  return result;
}

/// Whether a number of steps is whole, up to the rounding of the quotient.
bool are_whole(double n_steps) {
  return std::abs(n_steps - std::round(n_steps)) <= 1e-6;
}

Dynamics read_section(Table& table) {
  Dynamics result;
  result.where = table.where();
  result.scheme = read_scheme(table);
  const auto is_step = [](double step) { return step >= 1e-9 && step <= 1e6; };
  result.step = table.required("step", Number{"a number from 1e-9 to 1000000 (s)", is_step});
  const Entry end = table.entry("end");
  result.end = Number{"a number above 0 (s)", is_positive}(end);
  const double n_steps = result.end / result.step;
  if (!(n_steps >= 1 - 1e-6 && n_steps <= most_time_steps && are_whole(n_steps)))
    end.refuse("a whole number of steps of {} s, 1 to {:.0f}", result.step, most_time_steps);
  result.start = table.optional("start", read_name<MotionStart>).value_or(result.start);
  constexpr int most_written = 200; // bodies of a motion that does not say
  const int usual = (result.n_steps() + most_written - 1) / most_written;
  const WholeNumber count{"a whole number from 1: steps from one written body to the next", 1, 10000000};
  result.write_every = table.optional("write_every", count).value_or(usual);
  return result;
}

constexpr auto is_time = [](double time) { return time >= 0; };

/// Reads [[time, factor], ...].
std::vector<std::array<double, 2>> read_points(const Entry& entry) {
  const std::string allowed = "a list of [time (s), factor], with times from 0 that do not descend and of "
                              "which at most two in a row are equal";
  std::vector<std::array<double, 2>> points;
  for (const Entry& element : entry.elements(allowed)) {
    const std::vector<double> numbers = Numbers{"[time (s), factor], two finite numbers", 2}(element);
    const std::size_t n = points.size();
    const bool descends = n > 0 && numbers[0] < points[n - 1][0];
    const bool is_third = n > 1 && numbers[0] == points[n - 1][0] && numbers[0] == points[n - 2][0];
    if (!is_time(numbers[0]) || descends || is_third) element.refuse("part of " + allowed);
    points.push_back({numbers[0], numbers[1]});
  }
  return points;
}

History read_shape(const Entry& entry) {
  const std::string allowed =
      "a list of [time, factor], or { ramp = [from, to] }, { step = time } or { sine = hertz }";
  if (entry.node && entry.node->is_array()) return {read_points(entry)};
  Table table(entry, allowed);
  const auto is_frequency = [](double hertz) { return hertz > 0 && hertz <= 1e9; };
  const auto ramp = table.optional("ramp", Interval<>{"two times from 0 (s), the smaller first", is_time});
  const auto step = table.optional("step", Number{"a time from 0 (s)", is_time});
  const auto sine = table.optional("sine", Number{"a frequency above 0 (Hz), at most 1e9", is_frequency});
  table.refuse_unknown_keys();
  const int n_shapes = ramp.has_value() + step.has_value() + sine.has_value();
  if (n_shapes != 1) entry.refuse(allowed + (n_shapes > 1 ? ", one of them" : ""));
  if (ramp) return {{{(*ramp)[0], 0}, {(*ramp)[1], 1}}};
  if (step) return {{{*step, 0}, {*step, 1}}};
  return {{}, *sine};
}

/// A support that is somewhere else all of a sudden would have an infinite acceleration.
void check_motion(const Moved& moved, MotionStart start, std::size_t i) {
  const Where& where = moved.region.where;
  if (!moved.history.is_given())
    refuse(where, "moved[{}].history is missing, must say how the motion follows time beside [dynamics]", i);
  if (moved.history.jumps())
    refuse(where, "moved[{}].history jumps, must be continuous: a support has no infinite acceleration", i);
  if (start == MotionStart::rest && moved.history.at(0) != 0)
    refuse(where, "moved[{}].history is {} at time 0, must be 0 beside dynamics.start = \"rest\"", i,
           moved.history.at(0));
}

void check_densities(Table& root, const Case& definition) {
  if (!has_finite_elements(definition)) return; // masses are the nodes' own
  const bool has_gravity = std::any_of(definition.loads.begin(), definition.loads.end(),
                                       [](const Load& load) { return load.on() == loads::On::masses; });
  const bool has_density = definition.material_dynamics.density.has_value();
  if (!has_density && (definition.dynamics || has_gravity || !definition.masses.empty())) {
    Table material(root.entry("material"), "a table");
    material.entry("density").refuse("a number from 0.001 to 1000000 (kg/m³) beside {}",
                                     definition.dynamics ? "[dynamics]"
                                     : has_gravity       ? "a load of kind \"gravity\""
                                                         : "[[mass]]");
  }
  for (const RegionMaterial& region : definition.region_materials)
    if (region.dynamics.density.has_value() != has_density)
      throw InputError(region.where, has_density ? "density is missing, must be given as in [material]"
                                                 : "density must be left out as in [material]");
}

/// Reads [{ g = ..., k = ..., tau = ... }, ...].
std::vector<PronyTerm> read_prony(const Entry& entry) {
  const auto is_part = [](double part) { return part >= 0 && part < 1; };
  const Number part{"a number from 0 and below 1, a part of the instantaneous modulus", is_part};
  const Number time{"a number from 1e-9 to 1e9 (s)", [](double tau) { return tau >= 1e-9 && tau <= 1e9; }};
  std::vector<PronyTerm> terms;
  double g = 0, k = 0;
  for (const Entry& element : entry.elements("a list of { g = ..., k = ..., tau = ... }")) {
    Table table(element, "{ g = ..., k = ..., tau = ... }");
    PronyTerm term;
    term.g = table.required("g", part);
    term.k = table.optional("k", part).value_or(0);
    term.tau = table.required("tau", time);
    table.refuse_unknown_keys();
    terms.push_back(term);
    g += term.g, k += term.k;
  }
  if (!(g < 1 && k < 1))
    entry.refuse("terms whose g, and whose k, add up to less than 1: what is left carries the load at rest");
  return terms;
}

void check_memory(const Case& definition) {
  if (!has_memory(definition)) return;
  if (definition.msm.real_time)
    refuse(definition.msm.where,
           "real_time must be left out beside material.prony: its methods have no memory");
  if (definition.fem.real_time)
    refuse(definition.fem.where,
           "real_time must be left out beside material.prony: its methods have no memory");
  for (const PronyTerm& term : definition.material_dynamics.prony)
    if (!has_cells(definition.body) && term.k > 0)
      refuse(definition.msm.where, "a network has no volume terms: material.prony must have k = 0");
}

} // namespace

std::optional<Dynamics> read_dynamics(Table& root) {
  return root.section_if_there("dynamics", read_section);
}

MaterialDynamics read_material_dynamics(Table& table, bool has_dynamics) {
  MaterialDynamics result;
  const auto is_density = [](double value) { return value >= 1e-3 && value <= 1e6; };
  result.density = table.optional("density", Number{"a number from 0.001 to 1000000 (kg/m³)", is_density});
  table.refuse_unless(has_dynamics, {"mass_damping", "stiffness_damping"}, is_static);
  const Number rate{"a number, 0 or above (1/s)", is_not_negative},
      time{"a number, 0 or above (s)", is_not_negative};
  result.mass_damping = table.optional("mass_damping", rate).value_or(0);
  result.stiffness_damping = table.optional("stiffness_damping", time).value_or(0);
  table.refuse_unless(
      has_dynamics, {"prony"},
      "left out without [dynamics]: the moduli are those of rest, where nothing is remembered");
  result.prony = table.optional("prony", read_prony).value_or(std::vector<PronyTerm>{});
  return result;
}

History read_history(Table& table, bool has_dynamics) {
  table.refuse_unless(has_dynamics, {"history"}, is_static);
  return table.optional("history", read_shape).value_or(History{});
}

std::optional<OverTime> read_over_time(Table& table, const measures::Kind& kind, bool has_dynamics) {
  table.refuse_unless(has_dynamics, {"over_time"}, is_static);
  const bool is_field = is_field_norm(kind);
  table.refuse_unless(!is_field, {"over_time"}, "left out: the norm of a field is of the end");
  const auto given = table.optional("over_time", read_name<OverTime>);
  if (!has_dynamics || is_field) return std::nullopt;
  return given.value_or(OverTime::end);
}

/// Steps that are longer than half a period see another sine than the case's.
void check_sine(const History& history, const Dynamics& dynamics, const std::string& key, std::size_t i) {
  if (history.frequency * dynamics.step < 0.5) return;
  refuse(dynamics.where,
         "step is {:.10g} s, must be below half a period of {}[{}].history, a sine of {:.10g} Hz: {:.10g} s, "
         "and some twentieth of it to follow its course",
         dynamics.step, key, i, history.frequency, 0.5 / history.frequency);
}

void check_dynamics(Table& root, const Case& definition) {
  check_densities(root, definition);
  if (!definition.dynamics) return;
  check_memory(definition);
  for (std::size_t i = 0; i < definition.moved.size(); ++i)
    check_motion(definition.moved[i], definition.dynamics->start, i);
  check_turns_in_time(definition);
  for (std::size_t i = 0; i < definition.moved.size(); ++i)
    check_sine(definition.moved[i].history, *definition.dynamics, "moved", i);
  for (std::size_t i = 0; i < definition.loads.size(); ++i)
    check_sine(definition.loads[i].history, *definition.dynamics, "load", i);
  if (definition.fem.has_auto_formulation)
    throw InputError(definition.fem.where, "formulation must not be \"auto\" beside [dynamics]: whether the "
                                           "strains are small is known at the end alone");
  if (definition.msm.solver != Solver::newton)
    refuse(definition.msm.where,
           "solver is \"{}\", must be \"newton\" beside [dynamics]: the others find equilibria alone",
           name_of(definition.msm.solver));
}

} // namespace springproof::cases
