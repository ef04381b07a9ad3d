#pragma once

#include "cases/case/names.hpp"

#include <Eigen/Core>
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

/// Result of a solve of either model. A failed one has a message and the counters of the work done, but no
/// displacement.
struct Solution {
  Status status = Status::skipped;
  std::string message; ///< why it failed; of another one, what is to be said of how it was solved
  Outcome outcome = Outcome::unknown;
  std::vector<Eigen::Vector3d> displacement; ///< mm, one per node of the body's mesh
  std::vector<double> cell_volume;           ///< deformed volume of each cell of the body's mesh, mm³
  /// Set where several ranks have these two together: then here are those of sharing->here() alone.
  std::shared_ptr<const Sharing> sharing{};
  std::size_t unknowns = 0; ///< free degrees of freedom
  double residual = 0;      ///< |imbalance on free degrees of freedom| / |applied load|
  double load_reached = 0;  ///< 0 to 1
  int newton_iterations = 0;
  long linear_iterations = 0;
  long relaxation_iterations = 0; ///< of an explicit relaxation, which has no Newton iterations
  long force_evaluations = 0;     ///< internal forces of the whole body, with or without their tangent
  long factorisations = 0;        ///< of a tangent matrix; 0 where none is assembled
  std::optional<double>
      lowest_eigenvalue; ///< of the tangent on the free degrees of freedom, N/mm, when asked for
  std::optional<int>
      negative_eigenvalues; ///< of the tangent, from a factorisation's pivots; 0: a stable equilibrium
  int inverted_cells = 0;   ///< cells with a corner Jacobian <= 0

  /// As far as the tangent's eigenvalues were looked at.
  bool is_unstable() const {
    return outcome == Outcome::unstable_equilibrium || negative_eigenvalues.value_or(0) > 0;
  }
};

} // namespace springproof::cases
