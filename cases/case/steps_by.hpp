#pragma once

#include "cases/case/enumeration.hpp"
#include "cases/case/names.hpp"

#include <optional>
#include <string>

/// Steps as simulators make them: by an amount of work that is given, whatever it leaves.
namespace springproof::cases {

template<class Method>
struct StepsBy {
  Method method{};
  int iterations = 10;           ///< a substep; explicit methods have none
  std::optional<int> substeps{}; ///< in a step; absent: 1, of explicit methods as many as are stable
  /// Spectral radius of an iteration of projective_dynamics, which Chebyshev's method then accelerates.
  std::optional<double> chebyshev{};
  // For a body without [dynamics], which is to come to rest:
  double step = 1. / 60; ///< s
  double end = 20;       ///< s, within which it must
  double damping = 2;    ///< mass damping, 1/s
};

/// How simulators make a step of finite elements whose nodes are the cells' vertices.
SPRINGPROOF_ENUMERATION(
    ElementMethod,
    corotational,              ///< conjugate gradients, a rotation a cell (Mueller and Gross 2004)
    total_lagrangian_explicit, ///< the law's forces of where the step begins (Miller et al. 2007)
    xpbd                       ///< a neo-Hookean law as two constraints a cell (Macklin and Mueller 2021)
)
inline bool is_explicit(ElementMethod method) {
  return method == ElementMethod::total_lagrangian_explicit;
}

/// Whether a method moves elements of the case's formulation, not of a law of its own.
inline bool has_law_of_case(ElementMethod method) {
  return method == ElementMethod::total_lagrangian_explicit;
}

using ElementRealTime = StepsBy<ElementMethod>;

/// "xpbd, 10 iterations, 1 substep".  @param n_substeps  none: it is not told
template<class Method>
std::string text_of(const StepsBy<Method>& steps, std::optional<int> n_substeps) {
  std::string text = name_of(steps.method);
  const auto add = [&](const char* what, int n) {
    text += ", " + std::to_string(n) + ' ' + what + (n == 1 ? "" : "s");
  };
  if (!is_explicit(steps.method)) add("iteration", steps.iterations);
  if (n_substeps) add("substep", *n_substeps);
  return text;
}

} // namespace springproof::cases
