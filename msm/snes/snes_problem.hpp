#pragma once

#include "mechanics/equilibrium/find_equilibrium.hpp"
#include "mechanics/petsc/callback_errors.hpp"
#include "mechanics/petsc/distributed_problem.hpp"
#include "msm/snes/part.hpp"

namespace springproof::msm {

/// A lattice whose equilibrium at one load PETSc's SNES finds: vectors are the entries that a rank owns. The
/// equations contain the supports.
class SnesProblem : public mechanics::petsc::DistributedProblem {
 public:
  /// @param problem, settings  must outlive it
  SnesProblem(const Problem& problem, const mechanics::EquilibriumSettings& settings, MPI_Comm communicator);

  Vector state(const Points& displacement) const;
  Points displacement(const Vector& state) const;

  std::optional<Solved> solve_at(Vector& at, double load_factor) override;
  Vector residual(const Vector& at, double load_factor, mechanics::Expect expect) override;
  Size size(const Vector& residual, const Vector& at) override;
  /// By the factorisation's pivots, or by conjugate gradients for a random right side, which has a part in
  /// every mode, meeting no negative curvature.
  std::optional<bool> is_stable(const Vector& at) override;
  std::optional<Vector> direction(const Vector&, const Vector&, double, double,
                                  mechanics::Convexity) override {
    return std::nullopt; // solve_at() does it all
  }
  mechanics::Merit merit() const override { return mechanics::Merit::none; }
  Work work() const override { return work_; }

 private:
  const mechanics::EquilibriumSettings& settings_;
  Part part_;
  mechanics::petsc::Vector at_, residual_;
  mechanics::petsc::Matrix matrix_;
  mechanics::petsc::NonlinearSolver snes_;
  mechanics::petsc::CallbackErrors errors_;
  double load_factor_ = 0;
  Work work_;

  void make_solver();
  static PetscErrorCode evaluate_residual(SNES snes, Vec x, Vec out, void* problem);
  static PetscErrorCode evaluate_tangent(SNES snes, Vec x, Mat matrix, Mat, void* problem);
};

} // namespace springproof::msm
