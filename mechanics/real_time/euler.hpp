#pragma once

#include "cases/case/error.hpp"
#include "mechanics/real_time/step_equation.hpp"

#include <Eigen/SparseCore>
#include <string>

/// Euler's steps of points, by their internal forces.
namespace springproof::mechanics {

/// The tangent of internal forces on free degrees of freedom, as conjugate gradients take it.
struct FreeTangent {
  std::vector<int> number; ///< degree of freedom 3*point + component among the free ones, or -1
  int n_free;
  /// Lower triangle of a positive semidefinite matrix at a displacement (mm), N/mm; valid until the next
  /// call.
  std::function<const Eigen::SparseMatrix<double>&(const Points& displacement)> at;
};

/// Residual of a step's equation on free components, N.
Points residual_of(const StepEquation& step, const ForcesAt& forces, const Points& at);

MakeStep make_symplectic_euler(ForcesAt forces);

/// Newton's steps from where the step begins, whose linear equations conjugate gradients solve,
/// preconditioned by the diagonal; in all they have the given number of iterations. Few of them are one
/// linear solution a step (Baraff and Witkin 1998). A step that leaves 1 % of its residual is followed by
/// another.
MakeStep make_implicit_euler(ForcesAt forces, FreeTangent tangent, int iterations);

/// Steps that keep explicit ones stable: 80 % of 2/omega, where Gershgorin's circles bound omega² by the
/// largest sum of a row of M^-1 |K| at rest.
/// @param masses  t, one per point     @param step  s     @param method  its name
/// @throws cases::InputError at that place beyond 1e6
int stable_substeps(const FreeTangent& tangent, const std::vector<double>& masses, double step,
                    const std::string& method, const cases::Where& where);

} // namespace springproof::mechanics
