#include "msm/snes/snes.hpp"

#include "mechanics/equilibrium/find_equilibrium.hpp"
#include "mechanics/equilibrium/newton.hpp"
#include "mechanics/interruption.hpp"
#include "mechanics/petsc/distributed_problem.hpp"
#include "mechanics/ranks/share_out.hpp"
#include "msm/model.hpp"
#include "msm/snes/deal_out.hpp"
#include "msm/snes/lattice_part.hpp"

#include <cmath>
#include <random>

namespace springproof::msm {

using mechanics::petsc::check;
using mechanics::petsc::WriteEntries;
namespace petsc = mechanics::petsc;

namespace {

/// Unknowns up to which MUMPS factorises; there both ways take about as long.
constexpr int most_factorised_unknowns = 30000;

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

/// A lattice whose equilibrium at one load PETSc's SNES finds: Newton's method with a line search on the
/// residual, MUMPS up to most_factorised_unknowns, conjugate gradients with algebraic multigrid (GAMG)
/// beyond. Vectors are the entries that a rank owns. The equations contain the supports.
class SnesProblem : public petsc::DistributedProblem<> {
 public:
  /// @param problem, settings  must outlive it
  SnesProblem(const Problem& problem, const mechanics::EquilibriumSettings& settings, MPI_Comm communicator)
      : DistributedProblem(communicator), settings_(settings), part_(problem, communicator),
        at_(part_.make_vector()), residual_(part_.make_vector()), tangent_(part_.make_matrix()),
        snes_(petsc::get<SNES>(SNESCreate, communicator)) {
    const SNES snes = snes_.get();
    check(SNESSetOptionsPrefix(snes, "msm_"));
    const auto evaluate_residual = [](SNES, Vec at, Vec out, void* problem_of_snes) {
      auto& self = *static_cast<SnesProblem*>(problem_of_snes);
      return self.errors_.run([&] {
        mechanics::check_interruption();
        const auto& should_stop = self.settings_.should_stop;
        if (should_stop && self.any_rank(should_stop())) throw mechanics::Newton::Stopped{"it was stopped"};
        self.part_.residual(at, self.load_factor_, out);
      });
    };
    const auto evaluate_tangent = [](SNES, Vec at, Mat matrix, Mat, void* problem_of_snes) {
      auto& self = *static_cast<SnesProblem*>(problem_of_snes);
      return self.errors_.run([&] { self.part_.tangent(at, matrix); });
    };
    check(SNESSetFunction(snes, residual_.get(), evaluate_residual, this));
    check(SNESSetJacobian(snes, tangent_.get(), tangent_.get(), evaluate_tangent, this));
    check(SNESSetType(snes, SNESNEWTONLS));
    // On the residual: next to the solution the energy's change drowns in rounding, and PETSc's search with
    // it.
    check(SNESLineSearchSetType(petsc::get<SNESLineSearch>(SNESGetLineSearch, snes), SNESLINESEARCHBT));
    check(SNESSetTolerances(snes, settings.tolerance * part_.reference_force(), 0, 0,
                            settings.max_newton_per_step, PETSC_DEFAULT));
    choose_linear_solver();
    check(SNESSetFromOptions(snes));
  }
  SnesProblem(const SnesProblem&) = delete; // PETSc has its address
  SnesProblem& operator=(const SnesProblem&) = delete;

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
    const SNES snes = snes_.get();
    errors_.call([&] { return SNESSolve(snes, nullptr, at_.get()); });
    petsc::check_memory_of(linear_solver());
    work_.linear_iterations += petsc::get<PetscInt>(SNESGetLinearSolveIterations, snes);
    at = part_.own(at_.get());
    return Solved{petsc::get<SNESConvergedReason>(SNESGetConvergedReason, snes) > 0,
                  petsc::get<PetscInt>(SNESGetIterationNumber, snes),
                  petsc::get<PetscReal>(SNESGetFunctionNorm, snes) / part_.reference_force()};
  }

  void residual(const Vector& at, double load_factor, mechanics::Expect, Vector& residual) override {
    part_.put(at_.get(), at);
    part_.residual(at_.get(), load_factor, residual_.get());
    residual = -part_.own(residual_.get());
  }
  Size size(const Vector& residual, const Vector&) override {
    return {std::sqrt(dot(residual, residual)) / part_.reference_force()};
  }

  /// Judges by the factorisation's pivots, or by conjugate gradients for a random right side, which has a
  /// part in every mode, meeting no negative curvature.
  std::optional<bool> is_stable(const Vector& at) override {
    part_.put(at_.get(), at);
    part_.tangent(at_.get(), tangent_.get());
    return solves_any() && (!is_direct() || n_negative_pivots() == 0);
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
  petsc::Matrix tangent_;
  petsc::NonlinearSolver snes_;
  petsc::CallbackErrors errors_;
  double load_factor_ = 0;
  Work work_;

  KSP linear_solver() const { return petsc::get<KSP>(SNESGetKSP, snes_.get()); }
  PC preconditioner() const { return petsc::get<PC>(KSPGetPC, linear_solver()); }

  void choose_linear_solver() {
    const KSP linear = linear_solver();
    PetscInt n_unknowns = 0;
    check(MatGetSize(tangent_.get(), &n_unknowns, nullptr));
    if (n_unknowns <= most_factorised_unknowns) {
      check(KSPSetType(linear, KSPPREONLY));
      check(PCSetType(preconditioner(), PCCHOLESKY));
      // PETSc's CHOLMOD ends all on indefinite ones.
      check(PCFactorSetMatSolverType(preconditioner(), MATSOLVERMUMPS));
      return;
    }
    check(KSPSetType(linear, KSPCG));
    check(PCSetType(preconditioner(), PCGAMG));
    check(KSPSetTolerances(linear, 1e-5, PETSC_DEFAULT, PETSC_DEFAULT, 500));
    check(SNESKSPSetUseEW(snes_.get(), PETSC_TRUE));
  }

  /// Whether the linear solver converges for the tangent as it is and a random right side.
  bool solves_any() const {
    const petsc::Vector right = random_like(at_), solution = petsc::like(at_);
    const KSP linear = linear_solver();
    PetscReal usual = 0, absolute = 0, divergence = 0;
    PetscInt usual_iterations = 0;
    check(KSPGetTolerances(linear, &usual, &absolute, &divergence, &usual_iterations));
    const auto has_forcing = petsc::get<PetscBool>(SNESKSPGetUseEW, snes_.get());
    check(SNESKSPSetUseEW(snes_.get(), PETSC_FALSE)); // it would take the last iteration's tolerance
    check(KSPSetTolerances(linear, 1e-6, absolute, divergence, 1000));
    check(KSPSetOperators(linear, tangent_.get(), tangent_.get()));
    check(KSPSolve(linear, right.get(), solution.get()));
    check(KSPSetTolerances(linear, usual, absolute, divergence, usual_iterations));
    check(SNESKSPSetUseEW(snes_.get(), has_forcing));
    petsc::check_memory_of(linear);
    return petsc::get<KSPConvergedReason>(KSPGetConvergedReason, linear) > 0;
  }

  /// Whether the tangent is factorised.
  bool is_direct() const {
    PetscBool is_direct = PETSC_FALSE;
    check(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(preconditioner()), PCCHOLESKY, &is_direct));
    return is_direct == PETSC_TRUE;
  }
  /// Number of them in the last factorisation.
  long n_negative_pivots() const {
    const Mat factor = petsc::get<Mat>(PCFactorGetMatrix, preconditioner());
    return petsc::get<PetscInt>(MatMumpsGetInfog, factor, 12);
  }
};

} // namespace

cases::Solution solve_by_snes(const cases::Scene& scene, const SpringBody& springs, MPI_Comm communicator,
                              const mechanics::EquilibriumSettings& settings, const Points& start) {
  const auto sharing = mechanics::share_out(scene.mesh, communicator);
  if (takes_multigrid(scene, springs))
    return Model(scene, springs, {Path::multigrid, 1, deal_out_to(communicator), sharing})
        .solve(settings, start);
  Problem problem = make_problem(scene);
  problem.lattice = make_lattice(scene.mesh, springs);
  SnesProblem system(problem, settings, communicator);
  const mechanics::Equilibrium equilibrium =
      mechanics::find_equilibrium(system, system.state(start), "mass-spring equilibrium by SNES",
                                  mechanics::in_small_turns(largest_turn(scene.definition),
                                                            least_load_steps(scene.definition), settings));
  return solution_of(problem, equilibrium, system.displacement(equilibrium.state, sharing.get()), sharing);
}

} // namespace springproof::msm
