#pragma once

#include "cases/case/solution.hpp"
#include "cases/scene/loads.hpp"
#include "mechanics/contact/contact.hpp"
#include "mechanics/equilibrium/find_equilibrium.hpp"
#include "msm/lattice.hpp"

namespace springproof::msm {

using mechanics::Vector;

/// Nodes up to which a lattice is factorised where multigrid would take many iterations or fails.
constexpr std::size_t most_factorised = 40000;

/// A supported and loaded lattice.
struct Problem {
  cases::Mesh mesh;
  Lattice lattice;
  std::vector<cases::NodeVector> force; ///< applied at full load, N
  std::vector<bool> is_constrained;     ///< constrained degrees of freedom: 3*point + component
  /// Displacements (mm) of the constrained points that move, at a load factor; empty: none moves. The points
  /// and their order do not depend on the load factor. The result is valid until the next call.
  std::function<const std::vector<cases::NodeVector>&(double load_factor)> supports{};

  std::shared_ptr<mechanics::Contact> contact{}; ///< with the scene's tools; null: there are none

  /// One vector per point.
  Points on_all_points(const std::vector<cases::NodeVector>& some) const {
    return cases::on_all_nodes(some, mesh.nodes.size());
  }
};

/// A scene as springs see it, but for its lattice.
Problem make_problem(const cases::Scene& scene);
/// The same in motion: its loads are the inertia's, and a load factor is a time (s), which supports follow.
Problem make_moving_problem(const cases::Scene& scene);

/// Free degrees of freedom.
std::size_t n_unknowns(const Problem& problem);

/// Fills in what a solution's displacement says of the mesh's cells: deformed volumes, and how many are
/// inverted. Collective over the ranks that share it.
void measure_cells(const cases::Mesh& mesh, cases::Solution& solution);

/// What an equilibrium and its displacement (mm, one per point that is here) say of a problem.
/// @param sharing  the ranks that share the displacement; null: all of it is here
cases::Solution solution_of(const Problem& problem, const mechanics::Equilibrium& equilibrium,
                            Points displacement, std::shared_ptr<const cases::Sharing> sharing = {});

/// The equations of a problem. Vectors are displacements (mm) or forces (N).
class SpringSystem : public mechanics::NonlinearProblem {
 public:
  /// Applied forces at full load, N.
  virtual const Vector& load() const = 0;

  mechanics::Merit merit() const override { return mechanics::Merit::energy; }
  Size size(const Vector& residual, const Vector& at) override {
    const double load = std::sqrt(dot(this->load(), this->load()));
    const double scale = load > 0 ? load : reaction(at);
    return {std::sqrt(dot(residual, residual)) / (scale > 0 ? scale : 1.0)};
  }
  using NonlinearProblem::direction;
  bool direction(const Vector& at, const Vector& residual, double, double forcing,
                 mechanics::Convexity convexity, Vector& step) override {
    using mechanics::Convexity;
    return solve(at, residual, forcing, convexity == Convexity::clamped ? Clamp::yes : Clamp::no,
                 convexity == Convexity::shifted ? 2 * std::abs(lowest_mode(at)->eigenvalue) : 0, step);
  }
  Work work() const override { return work_; }

  /// Norm of the forces that springs exert on supports, N: what a body that is only moved is measured
  /// against.
  virtual double reaction(const Vector& displacement) = 0;

 protected:
  Work work_;

  /// Solves (tangent + shift) * step = residual, as direction() asks for.  @param shift  N/mm
  virtual bool solve(const Vector& displacement, const Vector& residual, double forcing, Clamp clamp,
                     double shift, Vector& step) = 0;
};

} // namespace springproof::msm
