#include "msm/snes/snes.hpp"

#include "mechanics/equilibrium/find_equilibrium.hpp"
#include "mechanics/equilibrium/turns.hpp"
#include "mechanics/petsc/distributed_problem.hpp"
#include "mechanics/ranks/share_out.hpp"
#include "msm/model.hpp"
#include "msm/snes/deal_out.hpp"
#include "msm/snes/lattice_part.hpp"
#include "msm/snes/snes_solver.hpp"

#include <cmath>
#include <random>

namespace springproof::msm {

using mechanics::petsc::check;
using mechanics::petsc::WriteEntries;
namespace petsc = mechanics::petsc;

namespace {

/// A right side with a part in every mode.
petsc::Vector random_like(const petsc::Vector& vector) {
  petsc::Vector right = petsc::like(vector);
  PetscInt first = 0, last = 0;
  check(VecGetOwnershipRange(right.get(), &first, &last));
  std::mt19937 generator(3u + static_cast<unsigned>(first));
  std::normal_distribution<double> normal;
  const WriteEntries entries(right.get());
  for (PetscInt d = 0; d < last - first; ++d) entries[d] = normal(generator);
  return right;
}

/// A lattice whose equilibrium at one load PETSc's SNES finds: vectors are the entries that a rank owns. The
/// equations contain the supports.
class SnesProblem : public petsc::DistributedProblem<> {
 public:
  /// @param problem, settings  must outlive it
  SnesProblem(const Problem& problem, const mechanics::EquilibriumSettings& settings, MPI_Comm communicator)
      : DistributedProblem(communicator), settings_(settings), part_(problem, communicator),
        at_(part_.make_vector()), residual_(part_.make_vector()),
        solver_({[this](Vec at, Vec residual) { part_.residual(at, load_factor_, residual); },
                 [this](Vec at, Mat tangent) { part_.tangent(at, tangent); },
                 [this] { return settings_.should_stop && any_rank(settings_.should_stop()); }},
                part_.make_vector(), part_.make_matrix(), settings.tolerance * part_.reference_force(),
                settings.max_newton_per_step) {}

  Vector state(const Points& displacement) const {
    return displacement.empty() ? part_.own(petsc::like(at_).get()) : part_.own(displacement);
  }
  Points displacement(const Vector& state, const cases::Sharing* sharing) const {
    return part_.deal(state, sharing);
  }

  std::optional<Solved> solve_at(Vector& at, double load_factor) override {
    load_factor_ = load_factor;
    part_.move_supports(at, load_factor);
    part_.put(at_.get(), at);
    Solved solved = solver_.solve(at_.get());
    solved.residual /= part_.reference_force();
    work_.linear_iterations += solver_.last_linear_iterations();
    at = part_.own(at_.get());
    return solved;
  }

  void residual(const Vector& at, double load_factor, mechanics::Expect, Vector& residual) override {
    part_.put(at_.get(), at);
    part_.residual(at_.get(), load_factor, residual_.get());
    residual = -part_.own(residual_.get());
  }
  Size size(const Vector& residual, const Vector&) override {
    return {std::sqrt(dot(residual, residual)) / part_.reference_force()};
  }

  /// By the factorisation's pivots, or by conjugate gradients for a random right side, which has a part in
  /// every mode, meeting no negative curvature.
  std::optional<bool> is_stable(const Vector& at) override {
    part_.put(at_.get(), at);
    part_.tangent(at_.get(), solver_.tangent());
    const petsc::Vector right = random_like(at_), solution = petsc::like(at_);
    const bool is_solved = solver_.solve_tangent(right.get(), solution.get(), 1e-6, 1000);
    return is_solved && (!solver_.is_direct() || solver_.n_negative_pivots() == 0);
  }
  bool direction(const Vector&, const Vector&, double, double, mechanics::Convexity, Vector&) override {
    return false; // solve_at() does it all
  }
  mechanics::Merit merit() const override { return mechanics::Merit::none; }
  Work work() const override { return work_; }
  std::size_t n_unknowns() const override { return part_.n_unknowns(); }

 private:
  const mechanics::EquilibriumSettings& settings_;
  LatticePart part_;
  petsc::Vector at_, residual_;
  SnesSolver solver_;
  double load_factor_ = 0;
  Work work_;
};

} // namespace

cases::Solution solve_by_snes(const cases::Scene& scene, const std::vector<CellStiffness>& stiffness,
                              MPI_Comm communicator, const mechanics::EquilibriumSettings& settings,
                              const Points& start) {
  if (takes_multigrid(scene, stiffness))
    return Model(scene, stiffness,
                 {Path::multigrid, 1, deal_out_to(communicator),
                  mechanics::share_out(scene.mesh, communicator)})
        .solve(settings, start);
  return solve_lattice_by_snes(scene, make_lattice(scene.mesh, stiffness), communicator, settings, start);
}

cases::Solution solve_lattice_by_snes(const cases::Scene& scene, Lattice lattice, MPI_Comm communicator,
                                      const mechanics::EquilibriumSettings& settings, const Points& start) {
  const auto sharing = mechanics::share_out(scene.mesh, communicator);
  Problem problem = make_problem(scene);
  problem.lattice = std::move(lattice);
  SnesProblem system(problem, settings, communicator);
  const mechanics::Equilibrium equilibrium =
      mechanics::find_equilibrium(system, system.state(start), "mass-spring equilibrium by SNES",
                                  mechanics::in_small_turns(largest_turn(scene.definition),
                                                            least_load_steps(scene.definition), settings));
  return solution_of(problem, equilibrium, system.displacement(equilibrium.state, sharing.get()), sharing);
}

} // namespace springproof::msm
