#pragma once

#include "mechanics/petsc/handles.hpp"
#include "msm/problem.hpp"

namespace springproof::msm {

/// A rank's part of a problem's lattice: its points, and the springs and cells whose first point is among
/// them. Points of others that these touch are ghosts at the end of the rank's own.
/// Vectors of PETSc have three entries per point; mechanics' vectors are the entries that a rank owns.
class LatticePart {
 public:
  /// @param problem  must outlive this
  LatticePart(const Problem& problem, MPI_Comm communicator);

  std::size_t n_unknowns() const { return msm::n_unknowns(problem_); } ///< over all ranks

  mechanics::petsc::Vector make_vector() const;
  /// Makes a matrix with the sparsity of the tangent, and all of the diagonal.
  mechanics::petsc::Matrix make_matrix() const;

  /// This rank's entries of values of all points.
  Vector own(const Points& values) const;
  /// Turns values of the points that this rank owns into those of the points that it shows of the answer.
  Points deal(const Vector& own, const cases::Sharing* sharing) const;

  /// Copies between PETSc's vectors and mechanics' vectors.
  void put(Vec vector, const Vector& own) const;
  Vector own(Vec vector) const;

  /// Minus the forces on the points at a displacement, N; of constrained degrees of freedom how far they are
  /// from where they should be, mm. SNES' function: it has the tangent as its derivative.
  void residual(Vec displacement, double load_factor, Vec out) const;
  /// The derivative of residual(): that of the forces, constrained.
  void tangent(Vec displacement, Mat matrix) const;
  /// Sets the constrained degrees of freedom.
  void move_supports(Vector& displacement, double load_factor) const;

  /// What residuals are measured against: the norm of the applied forces, N; 1 when there are none.
  double reference_force() const;

 private:
  const Problem& problem_;
  MPI_Comm communicator_;
  PetscInt first_ = 0, n_own_ = 0;
  std::vector<PetscInt> ghosts_;      ///< ascending
  std::vector<PetscInt> constrained_; ///< owned degrees of freedom
  Lattice lattice_;                   ///< in local numbers
  mechanics::petsc::Vector moved_, gradient_, applied_;

  bool owns(int point) const { return point >= first_ && point < first_ + n_own_; }
  PetscInt global(std::size_t local) const;
  int local(int point) const;
  void deal_out();
  Lattice part_of(const Lattice& whole) const;
  void add_tangent(const Points& positions, Mat matrix) const;
  Points local_displacement(Vec displacement) const;
  Points supports(double load_factor) const;
  double at(const Points& of_supports, PetscInt entry) const; ///< entry: constrained, owned
  /// Calls action(entry) for constrained ones among the owned entries.
  template<class Action>
  void for_each_constrained(const Action& action) const {
    for (const PetscInt d : constrained_) action(d - 3 * first_);
  }
};

} // namespace springproof::msm
