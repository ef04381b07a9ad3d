#include "msm/real_time/step_method.hpp"
#include "msm/tangent.hpp"

#include <Eigen/IterativeLinearSolvers>
#include <memory>

namespace springproof::msm {

namespace {

Points positions_at(const Lattice& lattice, const Points& displacement) {
  Points x = lattice.rest;
  for (std::size_t p = 0; p < x.size(); ++p) x[p] += displacement[p];
  return x;
}

} // namespace

Points residual_of(const StepEquation& step, const Lattice& lattice, const Points& at) {
  Points residual = internal_force(lattice, positions_at(lattice, at));
  for (std::size_t p = 0; p < residual.size(); ++p)
    residual[p] = (step.inertia[p].array() > 0).select(residual[p] + step.rest_of(p, at[p]), 0);
  return residual;
}

MakeStep make_symplectic_euler(const Lattice& lattice) {
  return [&lattice](const StepEquation& step, Points& at) {
    const Points residual = residual_of(step, lattice, step.origin);
    for (std::size_t p = 0; p < at.size(); ++p)
      at[p] = (step.inertia[p].array() > 0).select(step.origin[p] + step.moved_by(p, residual[p]), at[p]);
    return 1;
  };
}

/// Newton's steps from where the step begins, whose linear equations conjugate gradients solve,
/// preconditioned by the diagonal; in all they have the given number of iterations. Few of them are one
/// linear solution a step (Baraff and Witkin 1998). A step that leaves 1 % of its residual is followed by
/// another.
MakeStep make_implicit_euler(const Problem& problem, int iterations) {
  const auto tangent = std::make_shared<Tangent>(problem.lattice, problem.is_constrained);
  return [&lattice = problem.lattice, tangent, iterations](const StepEquation& step, Points& at) {
    const std::vector<int>& number = tangent->free_number();
    const auto visit_free = [&](const auto& action) {
      for (std::size_t dof = 0; dof < number.size(); ++dof)
        if (number[dof] >= 0) action(dof / 3, static_cast<int>(dof % 3), number[dof]);
    };
    visit_free([&](std::size_t p, int c, int) { at[p][c] = step.origin[p][c]; });
    Vector right_side(tangent->n_free()), inertia(tangent->n_free());
    visit_free([&](std::size_t p, int c, int n) { inertia[n] = step.inertia[p][c]; });
    int left = iterations;
    for (double first = 0; left > 0;) {
      const Points residual = residual_of(step, lattice, at);
      visit_free([&](std::size_t p, int c, int n) { right_side[n] = residual[p][c]; });
      first = std::max(first, right_side.norm());
      if (!(right_side.norm() > 1e-13 * first)) break;
      Tangent::Matrix matrix = tangent->assemble(positions_at(lattice, at), Clamp::yes);
      matrix.diagonal() += inertia;
      Eigen::ConjugateGradient<Tangent::Matrix, Eigen::Lower> solver(matrix);
      solver.setMaxIterations(left);
      solver.setTolerance(1e-2);
      const Vector moved = solver.solve(right_side);
      visit_free([&](std::size_t p, int c, int n) { at[p][c] += moved[n]; });
      left -= std::max(1, static_cast<int>(solver.iterations()));
    }
    return iterations - left;
  };
}

} // namespace springproof::msm
