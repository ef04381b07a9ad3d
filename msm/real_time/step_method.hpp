#pragma once

#include "mechanics/real_time/euler.hpp"
#include "msm/problem.hpp"

#include <optional>

/// How simulators make a step in time of springs.
namespace springproof::msm {

using mechanics::MakeStep;
using mechanics::StepEquation;

/// Residual of the equation on free components, N.
inline Points residual_of(const StepEquation& step, const Lattice& lattice, const Points& at) {
  return mechanics::residual_of(
      step, [&](const Points& displacement) { return internal_force_at(lattice, displacement); }, at);
}

// The methods. The lattice must outlive them.
MakeStep make_xpbd(const Lattice& lattice, int iterations, int n_threads);
/// @param chebyshev  spectral radius of an iteration; absent: no acceleration
MakeStep make_projective_dynamics(const Lattice& lattice, int iterations, std::optional<double> chebyshev);
MakeStep make_vertex_block_descent(const Lattice& lattice, int iterations, int n_threads);

} // namespace springproof::msm
