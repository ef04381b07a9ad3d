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
  double total_energy = 0;               ///< the whole body's, N mm
  bool has_stress = true;                ///< false for a network, whose springs belong to no cell:
                                         ///< strain_energy and stress are empty
  std::vector<double> strain_energy;     ///< N mm, one per cell
  std::vector<SymmetricTensor> stress;   ///< Cauchy stress, MPa: its mean over each deformed cell
  std::vector<SymmetricTensor> strain;   ///< ln V of each cell's mean deformation gradient; for small_strain,
                                         ///< the symmetric part of the displacement gradient's mean
};

/// What a tool does to a body in equilibrium.
struct ToolContact {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< on the body, N
  Eigen::Vector3d torque = Eigen::Vector3d::Zero(); ///< on the body, about Tool::at as it has moved, N mm
  double area = 0;                                  ///< surface at rest whose points are pressed, mm²
  double penetration = 0;                           ///< the deepest of a point of the surface, mm
  /// Forces on the nodes of the body's own mesh, N: those of points between them by the shape functions.
  std::vector<int> nodes{};
  std::vector<Eigen::Vector3d> on_nodes{};
};

/// A small vibration of a body.
struct Vibration {
  double omega;         ///< angular frequency, 1/s, without damping
  double damping_ratio; ///< by the body's own damping
};

/// A body's motion: what was watched of it at the start and after every step, and all of it now and then.
struct Trajectory {
  std::vector<double> time;                  ///< s, ascending; the first is the start
  std::vector<int> nodes;                    ///< watched ones of the body's mesh, ascending
  std::vector<Eigen::Vector3d> displacement; ///< mm, the watched nodes' at the first time, at the second ...
  std::vector<double> volume;                ///< the body's at these times, mm³; empty: it is not watched
  std::vector<ToolContact> tools; ///< all tools' at the first time, at the second ..., without nodes
  struct Body {
    int step;                                  ///< place among the times
    std::vector<Eigen::Vector3d> displacement; ///< mm, one per node of the body's mesh
  };
  std::vector<Body> bodies;    ///< every write_every steps; the first and the last
  int halved_steps = 0;        ///< how often a step was halved, because its equation was not solved
  int unfinished_steps = 0;    ///< steps that ended with more residual than the tolerance, in real time
  double largest_residual = 0; ///< at the end of a step, relative to the forces of the motion
  std::optional<Vibration> slowest{}; ///< about the start; absent: it is not known, or there is none
};

/// Distance of the solution after a given number of explicit iterations, or of where steps in real time leave
/// the body at rest, from the equilibrium of the same springs, which Newton's method finds.
struct FromEquilibrium {
  double tolerance; ///< an equilibrium's relative residual
  std::optional<double> largest,
      root_mean_square; ///< mm, over all points' distances from where they are in equilibrium
  std::string reason;   ///< why these are not known
  std::vector<Eigen::Vector3d> displacement{}; ///< that equilibrium's, mm, one per node; empty: not known
  struct Rest {
    double time; ///< s of the body's own time
    long steps;
  };
  std::optional<Rest> rest{}; ///< where steps in real time end
};

/// Norms of a displacement over the whole body at rest, for elements with nodes between the body's nodes,
/// which alone do not tell them.
struct FieldNorms {
  double root_mean_square; ///< mm
  double largest;          ///< mm, over the elements' nodes
};

/// Result of a solve of either model. A failed one has a message and the counters of the work done, but no
/// displacement.
struct Solution {
  Status status = Status::skipped;
  std::string message; ///< why it failed; else a remark on how it was solved
  Outcome outcome = Outcome::unknown;
  std::vector<Eigen::Vector3d> displacement; ///< mm, one per node of the body's mesh
  std::vector<double> cell_volume;           ///< deformed volume of each cell of the body's mesh, mm³
  std::optional<Fields> fields;              ///< when the case asks for them: Case::has_fields
  /// Set if several ranks have the three above together: then this rank has those of sharing->here() alone.
  std::shared_ptr<const Sharing> sharing{};
  std::size_t unknowns = 0; ///< free degrees of freedom
  double residual = 0;      ///< |imbalance on free degrees of freedom| / |applied load|
  double load_reached = 0;  ///< 0 to 1; for a motion, the part of its time
  int newton_iterations = 0;
  long linear_iterations = 0;
  long relaxation_iterations = 0; ///< explicit relaxation, which has no Newton iterations
  long force_evaluations = 0;     ///< internal forces of the whole body, with or without their tangent
  long factorisations = 0;        ///< tangent matrices; 0 where none is assembled
  std::optional<double> lowest_eigenvalue; ///< tangent on the free degrees of freedom, N/mm, when asked for
  std::optional<int>
      negative_eigenvalues;               ///< tangent, from a factorisation's pivots; 0: a stable equilibrium
  int inverted_cells = 0;                 ///< cells with a corner Jacobian <= 0
  std::optional<Trajectory> trajectory{}; ///< a dynamic case's; all else is about its end
  /// Present if the solution was asked for after a number of iterations, equilibrium or not.
  std::optional<FromEquilibrium> from_equilibrium{};

  std::vector<ToolContact> tools{}; ///< one for each of the case's tools

  std::optional<FieldNorms> norms{}; ///< if the case measures them, for quadratic elements and finer meshes

  bool is_equilibrium() const { return !from_equilibrium || residual <= from_equilibrium->tolerance; }

  /// Whether the solution is known to be unstable, as far as the tangent's eigenvalues were looked at.
  bool is_unstable() const {
    return outcome == Outcome::unstable_equilibrium || negative_eigenvalues.value_or(0) > 0;
  }
};

} // namespace springproof::cases
