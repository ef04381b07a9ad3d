#pragma once

#include "cases/case/models.hpp"
#include "cases/case/readers.hpp"

#include <fmt/format.h>

/// Steps of simulators, in [msm] and in [fem].
namespace springproof::cases {

inline const WholeNumber up_to_1000{"a whole number from 1 to 1000", 1, 1000};

/// Reads the keys that both models' methods have.
template<class Method>
StepsBy<Method> read_real_time(Table& table, const Case& definition) {
  StepsBy<Method> real_time;
  real_time.method = table.required("method", read_name<Method>);
  table.refuse_unless(
      !is_explicit(real_time.method), {"iterations"},
      fmt::format("left out: method = \"{}\" is explicit and has none", name_of(real_time.method)));
  real_time.iterations =
      table.optional("iterations", WholeNumber{"a whole number from 1 to 100000", 1, 100000})
          .value_or(real_time.iterations);
  real_time.substeps = table.optional("substeps", up_to_1000);
  table.refuse_unless(!definition.dynamics, {"step", "end", "damping"},
                      "left out beside [dynamics], which has its own");
  const Number time{"a time from 1e-7 to 1e6 (s)", [](double t) { return t >= 1e-7 && t <= 1e6; }};
  real_time.step = table.optional("step", time).value_or(real_time.step);
  real_time.end = table.optional("end", time).value_or(real_time.end);
  if (!(real_time.end / real_time.step <= most_time_steps)) table.entry("end").refuse("at most 1e7 steps");
  real_time.damping = table.optional("damping", Number{"a number, 0 or above (1/s)", is_not_negative})
                          .value_or(real_time.damping);
  return real_time;
}

/// Reads the same of springs, with the key of one of their methods.
inline RealTime read_steps(Table& table, const Case& definition) {
  RealTime real_time = read_real_time<StepMethod>(table, definition);
  table.refuse_unless(real_time.method == StepMethod::projective_dynamics, {"chebyshev"},
                      "left out: it belongs to method = \"projective_dynamics\"");
  real_time.chebyshev = table.optional(
      "chebyshev", Number{"a number above 0 and below 1", [](double rho) { return rho > 0 && rho < 1; }});
  return real_time;
}

/// Steps of implicit Euler are what the methods go towards, of points that have masses of their own.
/// @param entry  real_time     @param table  "msm" or "fem"
inline void check_steps(const Entry& entry, const char* table, const Case& definition) {
  const auto& dynamics = definition.dynamics;
  if (dynamics && dynamics->scheme.scheme != Scheme::implicit_euler)
    refuse(dynamics->where, "scheme is \"{}\", must be \"implicit_euler\" beside {}.real_time",
           name_of(dynamics->scheme.scheme), table);
  if (has_cells(definition.body) && !definition.material_dynamics.density)
    entry.refuse("left out without material.density");
  if (has_stiffness_damping(definition))
    entry.refuse("left out beside stiffness_damping: it damps masses alone");
}

} // namespace springproof::cases
