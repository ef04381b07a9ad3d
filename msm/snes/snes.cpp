#include "msm/snes/snes.hpp"

#include "mechanics/equilibrium/newton.hpp"
#include "mechanics/petsc/distributed_problem.hpp"
#include "msm/snes/part.hpp"

#include <random>

namespace springproof::msm {

using mechanics::petsc::check;
namespace petsc = mechanics::petsc;

namespace {

constexpr PetscInt direct_up_to = 30000; ///< unknowns; there both ways take about as long

/// A right side with a part in every mode.
petsc::Vector random_like(const petsc::Vector& vector) {
  petsc::Vector right = petsc::like(vector);
  PetscInt first = 0, last = 0;
  check(VecGetOwnershipRange(right.get(), &first, &last));
  std::mt19937 generator(3u + static_cast<unsigned>(first));
  std::normal_distribution<double> normal;
  const petsc::WriteEntries entries(right.get());
  for (PetscInt d = 0; d < last - first; ++d) entries[d] = normal(generator);
  return right;
}

/// A lattice whose equilibrium at one load PETSc's SNES finds: vectors are the entries that a rank owns. The
/// equations contain the supports.
class SnesProblem : public petsc::DistributedProblem {
 public:
  /// @param problem, settings  must outlive it
  SnesProblem(const Problem& problem, const mechanics::EquilibriumSettings& settings, MPI_Comm communicator)
      : DistributedProblem(communicator), settings_(settings), part_(problem, communicator),
        at_(part_.make_vector()), residual_(part_.make_vector()), matrix_(part_.make_matrix()) {
    make_solver();
  }

  Vector state(const Points& displacement) const {
    return displacement.empty() ? part_.own(petsc::like(at_).get()) : part_.own(displacement);
  }
  Points displacement(const Vector& state) const {
    const petsc::Vector all = petsc::like(at_);
    part_.put(all.get(), state);
    return part_.gather(all.get());
  }

  std::optional<Solved> solve_at(Vector& at, double load_factor) override {
    load_factor_ = load_factor;
    part_.put(at_.get(), at);
    part_.move_supports(at_.get(), load_factor);
    errors_.call([&] { return SNESSolve(snes_.get(), nullptr, at_.get()); });
    work_.linear_iterations += petsc::get<PetscInt>(SNESGetLinearSolveIterations, snes_.get());
    at = part_.own(at_.get());
    return Solved{petsc::get<SNESConvergedReason>(SNESGetConvergedReason, snes_.get()) > 0,
                  petsc::get<PetscInt>(SNESGetIterationNumber, snes_.get()),
                  petsc::get<PetscReal>(SNESGetFunctionNorm, snes_.get()) / part_.reference_force()};
  }

  Vector residual(const Vector& at, double load_factor, mechanics::Expect) override {
    part_.put(at_.get(), at);
    part_.residual(at_.get(), load_factor, residual_.get());
    return -part_.own(residual_.get());
  }
  Size size(const Vector& residual, const Vector&) override {
    return {std::sqrt(dot(residual, residual)) / part_.reference_force()};
  }

  /// By the factorisation's pivots, or by conjugate gradients for a random right side, which has a part in
  /// every mode, meeting no negative curvature.
  std::optional<bool> is_stable(const Vector& at) override {
    const KSP linear = petsc::get<KSP>(SNESGetKSP, snes_.get());
    const PC preconditioner = petsc::get<PC>(KSPGetPC, linear);
    PetscBool is_direct = PETSC_FALSE;
    check(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(preconditioner), PCCHOLESKY, &is_direct));
    part_.put(at_.get(), at);
    part_.tangent(at_.get(), matrix_.get());
    const petsc::Vector right = random_like(at_), solution = petsc::like(at_);
    check(KSPSetOperators(linear, matrix_.get(), matrix_.get()));
    if (!is_direct) check(KSPSetTolerances(linear, 1e-6, PETSC_DEFAULT, PETSC_DEFAULT, 1000));
    check(KSPSolve(linear, right.get(), solution.get()));
    const auto reason = petsc::get<KSPConvergedReason>(KSPGetConvergedReason, linear);
    if (!is_direct || reason <= 0) return reason > 0;
    const Mat factor = petsc::get<Mat>(PCFactorGetMatrix, preconditioner);
    return petsc::get<PetscInt>(MatMumpsGetInfog, factor, 12) == 0; // negative pivots
  }
  std::optional<Vector> direction(const Vector&, const Vector&, double, double,
                                  mechanics::Convexity) override {
    return std::nullopt; // solve_at() does it all
  }
  mechanics::Merit merit() const override { return mechanics::Merit::none; }
  Work work() const override { return work_; }

 private:
  const mechanics::EquilibriumSettings& settings_;
  Part part_;
  petsc::Vector at_, residual_;
  petsc::Matrix matrix_;
  petsc::NonlinearSolver snes_;
  petsc::CallbackErrors errors_;
  double load_factor_ = 0;
  Work work_;

  void make_solver() {
    const SNES snes = petsc::get<SNES>(SNESCreate, communicator_);
    snes_.reset(snes);
    check(SNESSetOptionsPrefix(snes, "msm_"));
    const auto evaluate_residual = [](SNES, Vec x, Vec out, void* problem) {
      auto& self = *static_cast<SnesProblem*>(problem);
      return self.errors_.run([&] {
        if (self.settings_.should_stop && self.any_rank(self.settings_.should_stop()))
          throw mechanics::Newton::Stopped{"it was stopped"};
        self.part_.residual(x, self.load_factor_, out);
      });
    };
    const auto evaluate_tangent = [](SNES, Vec x, Mat matrix, Mat, void* problem) {
      auto& self = *static_cast<SnesProblem*>(problem);
      return self.errors_.run([&] { self.part_.tangent(x, matrix); });
    };
    check(SNESSetFunction(snes, residual_.get(), evaluate_residual, this));
    check(SNESSetJacobian(snes, matrix_.get(), matrix_.get(), evaluate_tangent, this));
    check(SNESSetType(snes, SNESNEWTONLS));
    // On the residual: next to the solution the energy's change drowns in rounding, and PETSc's search with
    // it.
    check(SNESLineSearchSetType(petsc::get<SNESLineSearch>(SNESGetLineSearch, snes), SNESLINESEARCHBT));
    check(SNESSetTolerances(snes, settings_.tolerance * part_.reference_force(), 0, 0,
                            settings_.max_newton_per_step, PETSC_DEFAULT));
    const KSP linear = petsc::get<KSP>(SNESGetKSP, snes);
    const PC preconditioner = petsc::get<PC>(KSPGetPC, linear);
    PetscInt n_unknowns = 0;
    check(MatGetSize(matrix_.get(), &n_unknowns, nullptr));
    if (n_unknowns <= direct_up_to) {
      check(KSPSetType(linear, KSPPREONLY));
      check(PCSetType(preconditioner, PCCHOLESKY));
      check(PCFactorSetMatSolverType(preconditioner,
                                     MATSOLVERMUMPS)); // PETSc's CHOLMOD ends all on indefinite ones
    } else {
      check(KSPSetType(linear, KSPCG));
      check(PCSetType(preconditioner, PCGAMG));
      check(KSPSetTolerances(linear, 1e-5, PETSC_DEFAULT, PETSC_DEFAULT, 500));
      check(SNESKSPSetUseEW(snes, PETSC_TRUE));
    }
    check(SNESSetFromOptions(snes));
  }
};

} // namespace

cases::Solution solve_by_snes(const cases::Scene& scene, const std::vector<CellStiffness>& stiffness,
                              MPI_Comm communicator, const mechanics::EquilibriumSettings& settings,
                              const Points& start) {
  Problem problem = make_problem(scene);
  problem.lattice = make_lattice(scene.mesh, stiffness);
  SnesProblem system(problem, settings, communicator);
  const mechanics::Equilibrium equilibrium =
      mechanics::find_equilibrium(system, system.state(start), "mass-spring equilibrium by SNES", settings);
  return solution_of(problem, equilibrium, system.displacement(equilibrium.state));
}

} // namespace springproof::msm
