#include "msm/snes/snes.hpp"

#include "cases/mesh/sharing.hpp"
#include "mechanics/equilibrium/find_equilibrium.hpp"
#include "mechanics/equilibrium/newton.hpp"
#include "mechanics/interruption.hpp"
#include "mechanics/petsc/distributed_problem.hpp"
#include "mechanics/petsc/handles.hpp"
#include "mechanics/ranks/share_out.hpp"
#include "msm/model.hpp"
#include "msm/tangent.hpp"

#include <algorithm>
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

/// Leaves a lattice the terms whose first point is among some points. All points keep their numbers.
void keep_terms_of(Lattice& lattice, PetscInt first, PetscInt end) {
  for_each_kind(lattice, [&](auto& terms) {
    const auto is_of_others = [&](const auto& term) {
      return nodes_of(term)[0] < first || nodes_of(term)[0] >= end;
    };
    terms.erase(std::remove_if(terms.begin(), terms.end(), is_of_others), terms.end());
    terms.shrink_to_fit();
  });
}

/// A lattice whose equilibrium at one load PETSc's SNES finds: Newton's method with a line search on the
/// residual, MUMPS up to most_factorised_unknowns, conjugate gradients with algebraic multigrid (GAMG)
/// beyond. Vectors are the entries that a rank owns, three per point; every rank has the terms whose first
/// point it owns, and sees the displacement of all points. The equations contain the supports.
class SnesProblem : public petsc::DistributedProblem<> {
 public:
  /// @param problem, settings  must outlive it
  SnesProblem(const Problem& problem, const mechanics::EquilibriumSettings& settings, MPI_Comm communicator)
      : DistributedProblem(communicator), settings_(settings), problem_(problem),
        communicator_(communicator) {
    deal_out();
    lattice_ = problem.lattice;
    keep_terms_of(lattice_, first_, first_ + n_own_);
    applied_ = own(problem.on_all_points(problem.force));
    for_each_constrained([&](PetscInt entry) { applied_[entry] = 0; });
    const double force = std::sqrt(dot(applied_, applied_));
    reference_force_ = force > 0 ? force : 1;
    residual_ = petsc::like(at_);
    tangent_ = make_matrix();
    snes_.reset(petsc::get<SNES>(SNESCreate, communicator));
    const SNES snes = snes_.get();
    check(SNESSetOptionsPrefix(snes, "msm_"));
    const auto evaluate_residual = [](SNES, Vec at, Vec out, void* problem_of_snes) {
      auto& self = *static_cast<SnesProblem*>(problem_of_snes);
      return self.errors_.run([&] {
        mechanics::check_interruption();
        const auto& should_stop = self.settings_.should_stop;
        if (should_stop && self.any_rank(should_stop())) throw mechanics::Newton::Stopped{"it was stopped"};
        self.put(out, self.imbalance(self.own(at), self.load_factor_));
      });
    };
    const auto evaluate_tangent = [](SNES, Vec at, Mat matrix, Mat, void* problem_of_snes) {
      auto& self = *static_cast<SnesProblem*>(problem_of_snes);
      return self.errors_.run([&] { self.assemble(self.own(at), matrix); });
    };
    check(SNESSetFunction(snes, residual_.get(), evaluate_residual, this));
    check(SNESSetJacobian(snes, tangent_.get(), tangent_.get(), evaluate_tangent, this));
    check(SNESSetType(snes, SNESNEWTONLS));
    // On the residual: next to the solution the energy's change drowns in rounding, and PETSc's search with
    // it.
    check(SNESLineSearchSetType(petsc::get<SNESLineSearch>(SNESGetLineSearch, snes), SNESLINESEARCHBT));
    check(SNESSetTolerances(snes, settings.tolerance * reference_force_, 0, 0, settings.max_newton_per_step,
                            PETSC_DEFAULT));
    choose_linear_solver();
    check(SNESSetFromOptions(snes));
  }
  SnesProblem(const SnesProblem&) = delete; // PETSc has its address
  SnesProblem& operator=(const SnesProblem&) = delete;

  Vector state(const Points& displacement) const {
    return displacement.empty() ? Vector(Vector::Zero(3 * n_own_)) : own(displacement);
  }
  /// Turns values of the points that this rank owns into those of the points that it shows of the answer.
  Points displacement(const Vector& state, const cases::Sharing* sharing) const {
    std::vector<cases::Numbered<Eigen::Vector3d>> values;
    for (PetscInt p = 0; p < n_own_; ++p) values.push_back({first_ + p, state.segment<3>(3 * p)});
    return cases::deal(sharing, std::move(values), problem_.lattice.rest.size(), Eigen::Vector3d(0, 0, 0));
  }

  std::optional<Solved> solve_at(Vector& at, double load_factor) override {
    load_factor_ = load_factor;
    const Points prescribed = supports(load_factor);
    for_each_constrained([&](PetscInt entry) { at[entry] = of_support(prescribed, entry); });
    put(at_.get(), at);
    const SNES snes = snes_.get();
    errors_.call([&] { return SNESSolve(snes, nullptr, at_.get()); });
    petsc::check_memory_of(linear_solver());
    work_.linear_iterations += petsc::get<PetscInt>(SNESGetLinearSolveIterations, snes);
    at = own(at_.get());
    return Solved{petsc::get<SNESConvergedReason>(SNESGetConvergedReason, snes) > 0,
                  petsc::get<PetscInt>(SNESGetIterationNumber, snes),
                  petsc::get<PetscReal>(SNESGetFunctionNorm, snes) / reference_force_};
  }

  void residual(const Vector& at, double load_factor, mechanics::Expect, Vector& residual) override {
    residual = -imbalance(at, load_factor);
  }
  Size size(const Vector& residual, const Vector&) override {
    return {std::sqrt(dot(residual, residual)) / reference_force_};
  }

  /// Judges by the factorisation's pivots, or by conjugate gradients for a random right side, which has a
  /// part in every mode, meeting no negative curvature.
  std::optional<bool> is_stable(const Vector& at) override {
    assemble(at, tangent_.get());
    return solves_any() && (!is_direct() || n_negative_pivots() == 0);
  }
  bool direction(const Vector&, const Vector&, double, double, mechanics::Convexity, Vector&) override {
    return false; // solve_at() does it all
  }
  mechanics::Merit merit() const override { return mechanics::Merit::none; }
  Work work() const override { return work_; }
  std::size_t n_unknowns() const override { return msm::n_unknowns(problem_); }

 private:
  const mechanics::EquilibriumSettings& settings_;
  const Problem& problem_;
  MPI_Comm communicator_;
  PetscInt first_ = 0, n_own_ = PETSC_DECIDE; ///< points of this rank
  std::vector<int> n_entries_, first_entry_;  ///< every rank's
  std::vector<PetscInt> constrained_;         ///< owned degrees of freedom
  Lattice lattice_;                           ///< this rank's terms
  Vector applied_;                            ///< forces at full load on free degrees of freedom, N
  double reference_force_ = 1;                ///< norm of the applied forces, N; 1 when there are none
  petsc::Vector at_, residual_;
  petsc::Matrix tangent_;
  petsc::NonlinearSolver snes_;
  petsc::CallbackErrors errors_;
  double load_factor_ = 0;
  Work work_;

  void deal_out() {
    auto all = static_cast<PetscInt>(problem_.lattice.rest.size());
    check(PetscSplitOwnership(communicator_, &n_own_, &all));
    at_.reset(petsc::get<Vec>(VecCreateMPI, communicator_, 3 * n_own_, PETSC_DECIDE));
    const auto* ends = petsc::get<const PetscInt*>(VecGetOwnershipRanges, at_.get());
    int n_ranks = 1, rank = 0;
    MPI_Comm_size(communicator_, &n_ranks);
    MPI_Comm_rank(communicator_, &rank);
    first_entry_.assign(ends, ends + n_ranks);
    for (int r = 0; r < n_ranks; ++r) n_entries_.push_back(static_cast<int>(ends[r + 1] - ends[r]));
    first_ = ends[rank] / 3;
    for (PetscInt d = 3 * first_; d < 3 * (first_ + n_own_); ++d)
      if (problem_.is_constrained[cases::index(d)]) constrained_.push_back(d);
  }

  /// Calls action(entry) for constrained ones among the owned entries.
  template<class Action>
  void for_each_constrained(const Action& action) const {
    for (const PetscInt d : constrained_) action(d - 3 * first_);
  }
  /// Where supports are, mm, one per point of all; empty: where they were at rest.
  Points supports(double load_factor) const {
    return problem_.supports ? problem_.on_all_points(problem_.supports(load_factor)) : Points{};
  }
  double of_support(const Points& prescribed, PetscInt entry) const {
    return prescribed.empty() ? 0 : prescribed.front().data()[3 * first_ + entry];
  }

  /// Copies this rank's entries.
  Vector own(const Points& values) const {
    return Eigen::Map<const Vector>(values.front().data() + 3 * first_, 3 * n_own_);
  }
  Vector own(Vec vector) const {
    return Eigen::Map<const Vector>(petsc::ReadEntries(vector).data(), 3 * n_own_);
  }
  void put(Vec vector, const Vector& own) const {
    std::copy(own.begin(), own.end(), WriteEntries(vector).data());
  }
  Points of_all_ranks(const Vector& own) const {
    Points all(problem_.lattice.rest.size());
    MPI_Allgatherv(own.data(), static_cast<int>(own.size()), MPI_DOUBLE, all.front().data(),
                   n_entries_.data(), first_entry_.data(), MPI_DOUBLE, communicator_);
    return all;
  }

  /// Minus the forces on the points at a displacement, N; of constrained degrees of freedom how far they are
  /// from where they should be, mm: an iterative solver moves the supports a little, and the next step has to
  /// bring them back. SNES' function: it has the tangent as its derivative.
  Vector imbalance(const Vector& at, double load_factor) const {
    const Points force = internal_force_at(lattice_, of_all_ranks(at)), prescribed = supports(load_factor);
    Vector sum(at.size());
    MPI_Reduce_scatter(force.front().data(), sum.data(), n_entries_.data(), MPI_DOUBLE, MPI_SUM,
                       communicator_);
    sum = -sum - load_factor * applied_;
    for_each_constrained([&](PetscInt entry) { sum[entry] = at[entry] - of_support(prescribed, entry); });
    return sum;
  }

  /// The derivative of imbalance(): that of the forces, constrained.
  void assemble(const Vector& at, Mat matrix) const {
    check(MatZeroEntries(matrix));
    Points positions = of_all_ranks(at);
    for (std::size_t p = 0; p < positions.size(); ++p) positions[p] += lattice_.rest[p];
    add_tangent(positions, matrix);
    check(MatZeroRowsColumns(matrix, static_cast<PetscInt>(constrained_.size()), constrained_.data(), 1,
                             nullptr, nullptr));
  }
  void add_tangent(const Points& positions, Mat matrix) const {
    const auto add = [&](PetscInt row, PetscInt column, const Eigen::Matrix3d& block) {
      const Eigen::Matrix3d transposed = block.transpose(); // PETSc wants rows, Eigen stores columns
      check(MatSetValuesBlocked(matrix, 1, &row, 1, &column, transposed.data(), ADD_VALUES));
      if (row != column) check(MatSetValuesBlocked(matrix, 1, &column, 1, &row, block.data(), ADD_VALUES));
    };
    visit_tangent_blocks(lattice_, positions, Clamp::no, add);
    check(MatAssemblyBegin(matrix, MAT_FINAL_ASSEMBLY));
    check(MatAssemblyEnd(matrix, MAT_FINAL_ASSEMBLY));
  }

  /// Makes a matrix with the sparsity of the tangent, and all of the diagonal.
  petsc::Matrix make_matrix() const {
    const auto create = [&](MatType type) {
      const Mat made = petsc::get<Mat>(MatCreate, communicator_);
      petsc::Matrix owned(made);
      check(MatSetSizes(made, 3 * n_own_, 3 * n_own_, PETSC_DECIDE, PETSC_DECIDE));
      check(MatSetType(made, type));
      check(MatSetBlockSize(made, 3));
      return owned;
    };
    petsc::Matrix matrix = create(MATAIJ); // GAMG's coarsening wants it, with its block size
    const petsc::Matrix sparsity = create(MATPREALLOCATOR);
    check(MatSetUp(sparsity.get()));
    const Eigen::Matrix3d none = Eigen::Matrix3d::Zero(); // block of points that no spring holds
    for (PetscInt p = first_; p < first_ + n_own_; ++p)
      check(MatSetValuesBlocked(sparsity.get(), 1, &p, 1, &p, none.data(), ADD_VALUES));
    add_tangent(lattice_.rest, sparsity.get());
    check(MatPreallocatorPreallocate(sparsity.get(), PETSC_TRUE, matrix.get()));
    // Constrained rows keep their zeros: a factorisation is analysed once.
    check(MatSetOption(matrix.get(), MAT_KEEP_NONZERO_PATTERN, PETSC_TRUE));
    check(MatSetOption(matrix.get(), MAT_SYMMETRIC, PETSC_TRUE));
    // Where it is not definite, the pivots' signs or conjugate gradients tell.
    check(MatSetOption(matrix.get(), MAT_SPD, PETSC_TRUE));
    petsc::attach_rigid_motions(
        matrix.get(), Points(lattice_.rest.begin() + first_, lattice_.rest.begin() + first_ + n_own_));
    return matrix;
  }

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
