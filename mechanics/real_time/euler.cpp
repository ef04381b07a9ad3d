#include "mechanics/real_time/euler.hpp"

#include "mechanics/grid/krylov.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace springproof::mechanics {

namespace {

using Matrix = Eigen::SparseMatrix<double>;

/// action(point, component, number) for the free degrees of freedom.
template<class Action>
void visit_free(const FreeTangent& tangent, const Action& action) {
  for (std::size_t dof = 0; dof < tangent.number.size(); ++dof)
    if (tangent.number[dof] >= 0) action(dof / 3, static_cast<int>(dof % 3), tangent.number[dof]);
}

} // namespace

Points residual_of(const StepEquation& step, const ForcesAt& forces, const Points& at) {
  Points residual = forces(at);
  if (step.pull) {
    const Eigen::Vector3d force = step.pull->force(at);
    for (const auto& [point, weight] : step.pull->weights) residual[point] += weight * force;
  }
  for (std::size_t p = 0; p < residual.size(); ++p)
    residual[p] = (step.inertia[p].array() > 0).select(residual[p] + step.rest_of(p, at[p]), 0);
  return residual;
}

MakeStep make_symplectic_euler(ForcesAt forces) {
  return [forces = std::move(forces)](const StepEquation& step, Points& at) {
    const Points residual = residual_of(step, forces, step.origin);
    for (std::size_t p = 0; p < at.size(); ++p)
      at[p] = (step.inertia[p].array() > 0).select(step.origin[p] + step.moved_by(p, residual[p]), at[p]);
    if (step.pull) { // explicitly, a stiff one would not be stable
      Eigen::Vector3d force = step.pull->force(step.origin);
      project_pull(
          *step.pull, [&](std::size_t p, const Eigen::Vector3d& by) { return step.moved_by(p, by); }, force,
          at);
    }
    return 1;
  };
}

MakeStep make_implicit_euler(ForcesAt forces, FreeTangent tangent, int iterations) {
  return [forces = std::move(forces), tangent = std::move(tangent), iterations](const StepEquation& step,
                                                                                Points& at) {
    visit_free(tangent, [&](std::size_t p, int c, int) { at[p][c] = step.origin[p][c]; });
    Eigen::VectorXd right_side(tangent.n_free), inertia(tangent.n_free);
    visit_free(tangent, [&](std::size_t p, int c, int n) { inertia[n] = step.inertia[p][c]; });
    int left = iterations;
    for (double first = 0; left > 0;) {
      const Points residual = residual_of(step, forces, at);
      visit_free(tangent, [&](std::size_t p, int c, int n) { right_side[n] = residual[p][c]; });
      first = std::max(first, right_side.norm());
      if (!(right_side.norm() > 1e-13 * first)) break;
      Matrix matrix = tangent.at(at);
      matrix.diagonal() += inertia;
      const auto solved = grid::conjugate_gradients(
          [&](const Eigen::VectorXd& in, Eigen::VectorXd& out) {
            out = matrix.selfadjointView<Eigen::Lower>() * in;
            if (step.pull) step.pull->add_product(tangent.number, in, out);
          },
          [diagonal = Eigen::VectorXd(matrix.diagonal())](const Eigen::VectorXd& in, Eigen::VectorXd& out) {
            out = in.cwiseQuotient(diagonal);
          },
          right_side, 1e-2 * right_side.norm(), left,
          [](const Eigen::VectorXd& a, const Eigen::VectorXd& b) { return a.dot(b); }, 1);
      visit_free(tangent, [&](std::size_t p, int c, int n) { at[p][c] += solved.solution[n]; });
      left -= std::max(1, solved.iterations);
    }
    return iterations - left;
  };
}

int stable_substeps(const FreeTangent& tangent, const std::vector<double>& masses, double step,
                    const std::string& method, const cases::Where& where) {
  const Matrix whole =
      tangent.at(Points(masses.size(), Eigen::Vector3d::Zero())).selfadjointView<Eigen::Lower>();
  double squared = 0; // omega², 1/s²
  visit_free(tangent, [&](std::size_t p, int, int n) {
    squared = std::max(squared, whole.col(n).cwiseAbs().sum() / masses[p]);
  });
  constexpr double most = 1e6;
  const double n = std::ceil(step * std::sqrt(squared) / (0.8 * 2));
  if (!(n <= most))
    cases::refuse(where,
                  "real_time: {} needs {:.3g} substeps of a step of {:g} s to be stable, above {:g}; take an "
                  "implicit method or a shorter step",
                  method, n, step, most);
  return std::max(1, static_cast<int>(n));
}

} // namespace springproof::mechanics
