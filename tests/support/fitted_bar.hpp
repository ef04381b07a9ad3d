#pragma once

#include "compare/error_bars/auto_fem.hpp"
#include "compare/fit/fit.hpp"

/// A body whose moduli are fitted, and what solves it.
namespace fitted_bar {

/// An eighth of a bar under tension, whose strains are the same everywhere: u = (-nu x, -nu y, z) T/E.
inline const std::string text = R"(schema = 1
name = "bar"
body = { shape = "box", size = [10, 10, 10], cells = [2, 2, 2] }
material = { model = "linear_elastic", youngs_modulus = 1, poissons_ratio = 0.3 }
symmetry = [{ plane = "x-" }, { plane = "y-" }, { plane = "z-" }]
load = [{ region = "z+", kind = "traction", value = [0, 0, 0.01] }]
fem = { formulation = "small_strain", element = "q1" }
)";

constexpr double true_modulus = 0.62, true_ratio = 0.41; ///< the measured bar's, MPa and none

/// Solves in this process.
inline std::vector<springproof::compare::Answers>
answer(const std::vector<springproof::compare::Question>& questions) {
  std::vector<springproof::compare::Answers> all;
  for (const auto& question : questions)
    all.push_back(
        springproof::compare::solve(question.scene, question.request, springproof::compare::solve_fem));
  return all;
}

} // namespace fitted_bar
