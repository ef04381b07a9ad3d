#pragma once

#include "cases/case/names.hpp"

#include <Eigen/Core>
#include <array>
#include <memory>
#include <vector>

namespace springproof::cases {

/// What became of a body under its load. Written with blanks: "stable equilibrium".
SPRINGPROOF_ENUMERATION(Outcome,
                        unknown,              ///< the solver gave up, or stability was not looked at
                        stable_equilibrium,   ///< full load carried, tangent positive definite
                        unstable_equilibrium, ///< in balance, but some small motion lowers the energy
                        limit_point,          ///< the path from rest ends below the full load
                        mechanism,            ///< some motion meets no stiffness at rest
                        refused               ///< the input makes no model
)
inline char between_words(Outcome) {
  return ' ';
}

class Sharing;

SPRINGPROOF_ENUMERATION(Status, converged, failed, skipped)

/// A symmetric tensor, in VTK's order.
using SymmetricTensor = std::array<double, 6>; ///< xx, yy, zz, xy, yz, xz

/// What an equilibrium puts on the body's own mesh beside the displacement. Both models define them alike:
/// see mechanics/field_sums.hpp.
struct Fields {
  std::vector<Eigen::Vector3d> reaction; ///< force of the supports on the body, N, one per node; 0 on free
                                         ///< degrees of freedom
  double total_energy = 0;               ///< N mm, of the whole body
  bool has_stress = true;              ///< false of a network, whose springs belong to no cell: strain_energy
                                       ///< and stress are empty
  std::vector<double> strain_energy;   ///< N mm, one per cell
  std::vector<SymmetricTensor> stress; ///< Cauchy stress, MPa: its mean over each deformed cell
  std::vector<SymmetricTensor> strain; ///< ln V of each cell's mean deformation gradient; of small_strain,
                                       ///< the symmetric part of the displacement gradient's mean
};

/// A body's motion: what was watched of it at the start and after every step, and all of it now and then.
/// A small vibration of a body.
struct Vibration {
  double omega;         ///< angular frequency, 1/s, without damping
  double damping_ratio; ///< by the body's own damping
};

struct Trajectory {
  std::vector<double> time; ///< s, ascending; the first is the start
  std::vector<int> nodes;   ///< watched ones of the body's mesh, ascending
  std::vector<Eigen::Vector3d>
      displacement;           ///< mm, of the watched nodes at the first time, at the second ...
  std::vector<double> volume; ///< mm³, of the body at these times; empty: it is not watched
  struct Body {
    int step;                                  ///< place among the times
    std::vector<Eigen::Vector3d> displacement; ///< mm, one per node of the body's mesh
  };
  std::vector<Body> bodies;           ///< every write_every steps; the first and the last
  int halved_steps = 0;               ///< how often a step was halved, because its equation was not solved
  int unfinished_steps = 0;           ///< that were taken with more residual than the tolerance, in real time
  double largest_residual = 0;        ///< that a step was left with, relative to the forces of the motion
  std::optional<Vibration> slowest{}; ///< about the start; absent: it is not known, or there is none
};

/// How far an answer after a given number of explicit iterations is from the equilibrium of the same springs,
/// which Newton's method finds.
struct FromEquilibrium {
  double tolerance; ///< an equilibrium's relative residual
  std::optional<double> largest,
      root_mean_square; ///< mm, of all points' distances from where they are in equilibrium
  std::string reason;   ///< why these are not known
  std::vector<Eigen::Vector3d> displacement{}; ///< that equilibrium's, mm, one per node; empty: not known
};

/// Norms of a displacement over all of the body at rest, where the body's nodes do not tell them: of elements
/// with nodes between these.
struct FieldNorms {
  double root_mean_square; ///< mm
  double largest;          ///< mm, of the elements' nodes
};

/// Result of a solve of either model. A failed one has a message and the counters of the work done, but no
/// displacement.
struct Solution {
  Status status = Status::skipped;
  std::string message; ///< why it failed; of another one, what is to be said of how it was solved
  Outcome outcome = Outcome::unknown;
  std::vector<Eigen::Vector3d> displacement; ///< mm, one per node of the body's mesh
  std::vector<double> cell_volume;           ///< deformed volume of each cell of the body's mesh, mm³
  std::optional<Fields> fields;              ///< when the case asks for them: Case::has_fields
  /// Set where several ranks have these three together: then here are those of sharing->here() alone.
  std::shared_ptr<const Sharing> sharing{};
  std::size_t unknowns = 0; ///< free degrees of freedom
  double residual = 0;      ///< |imbalance on free degrees of freedom| / |applied load|
  double load_reached = 0;  ///< 0 to 1; of a motion, the part of its time
  int newton_iterations = 0;
  long linear_iterations = 0;
  long relaxation_iterations = 0; ///< explicit relaxation, which has no Newton iterations
  long force_evaluations = 0;     ///< internal forces of the whole body, with or without their tangent
  long factorisations = 0;        ///< tangent matrices; 0 where none is assembled
  std::optional<double> lowest_eigenvalue; ///< tangent on the free degrees of freedom, N/mm, when asked for
  std::optional<int>
      negative_eigenvalues;               ///< tangent, from a factorisation's pivots; 0: a stable equilibrium
  int inverted_cells = 0;                 ///< cells with a corner Jacobian <= 0
  std::optional<Trajectory> trajectory{}; ///< a dynamic case's: the rest is of its end
  /// Present where the answer was asked for after a number of iterations, equilibrium or not.
  std::optional<FromEquilibrium> from_equilibrium{};

  std::optional<FieldNorms> norms{}; ///< when the case measures them, of quadratic elements and finer meshes

  bool is_equilibrium() const { return !from_equilibrium || residual <= from_equilibrium->tolerance; }

  /// As far as the tangent's eigenvalues were looked at.
  bool is_unstable() const {
    return outcome == Outcome::unstable_equilibrium || negative_eigenvalues.value_or(0) > 0;
  }
};

} // namespace springproof::cases
