#pragma once

#include "mechanics/petsc/distributed_problem.hpp"
#include "msm/moving_springs.hpp"
#include "msm/snes/lattice_part.hpp"
#include "msm/snes/snes_solver.hpp"

namespace springproof::msm {

/// The static equations of a rank's part of a lattice without loads, whose load factor is a time (s): their
/// forces and supports, not their solution. Vectors are the entries that the rank owns.
class PartInTime : public mechanics::petsc::DistributedProblem<> {
 public:
  /// @param part  of a problem of make_moving_problem(); must outlive this
  PartInTime(const LatticePart& part, MPI_Comm communicator)
      : DistributedProblem(communicator), part_(part) {}

  void residual(const Vector& at, double time, mechanics::Expect expect, Vector& residual) override;
  void move_supports(Vector& at, double time) const override { part_.move_supports(at, time); }
  bool moves_supports() const override { return part_.has_moving_supports(); }
  Work work() const override { return work_; }
  std::size_t n_unknowns() const override { return part_.n_unknowns(); }

  Size size(const Vector& residual, const Vector& /*at*/) override {
    return {std::sqrt(dot(residual, residual))};
  }
  bool direction(const Vector&, const Vector&, double, double, mechanics::Convexity, Vector&) override {
    return false;
  }
  mechanics::Merit merit() const override { return mechanics::Merit::none; }
  std::optional<bool> is_stable(const Vector& /*at*/) override { return std::nullopt; }

 private:
  const LatticePart& part_;
  Work work_;
};

/// The motion of a lattice over the ranks of a communicator: PETSc's SNES solves the equation of a step.
class MovingPart : public MovingSprings {
 public:
  /// @param problem   that the part is of
  /// @param inertia   of the whole lattice
  /// @param settings  of each step; must outlive this, as must part and springs
  MovingPart(const Problem& problem, const LatticePart& part, PartInTime& springs, const Inertia& inertia,
             const mechanics::EquilibriumSettings& settings);

  std::optional<Solved> solve_at(Vector& at, double load_factor) override;
  using MovingSprings::direction;
  /// With the exact tangent.
  bool direction(const Vector& at, const Vector& residual, double load_factor, double forcing,
                 mechanics::Convexity convexity, Vector& step) override;
  mechanics::Merit merit() const override {
    return mechanics::Merit::none;
  } ///< solve_at() looks at no energy

 private:
  const LatticePart& part_;
  const mechanics::EquilibriumSettings& settings_;
  mechanics::petsc::Vector at_, right_, moved_, product_, diagonal_of_step_;
  mechanics::petsc::Matrix damping_; ///< by stiffness, supports that move with it; none: no such damping
  SnesSolver solver_;
  Vector state_, residual_;

  double reaction(const Vector& at) override;
  bool has_stiffness_damping() const override { return damping_ != nullptr; }
  void add_stiffness_damping(const Vector& motion, Vector& product) override;
  /// Functions of SNES.
  void evaluate(Vec at, Vec residual);
  void linearise(Vec at, Mat tangent);
};

} // namespace springproof::msm
