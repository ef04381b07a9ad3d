#include "msm/snes/snes.hpp"

#include "cases/case/error.hpp"
#include "cases/case/index.hpp"
#include "mechanics/petsc/rigid_motions.hpp"
#include "msm/problem.hpp"
#include "msm/tangent.hpp"

#include <algorithm>
#include <random>
#include <set>
#include <string>

namespace springproof::msm {

namespace {

using cases::index;
using mechanics::petsc::check;
namespace petsc = mechanics::petsc;

constexpr PetscInt direct_up_to = 30000; ///< unknowns; there both ways take about as long

/// A rank's part of the lattice: its points, and the springs and cells whose first point is among them.
/// Points of others that these touch are ghosts at the end of the rank's own.
class Part {
 public:
  Part(const Problem& problem, MPI_Comm communicator) : problem_(problem), communicator_(communicator) {
    deal_out();
    lattice_.rest.resize(index(n_own_) + ghosts_.size());
    for (std::size_t local = 0; local < lattice_.rest.size(); ++local)
      lattice_.rest[local] = problem.lattice.rest[index(global(local))];
    for (const Link& link : problem.lattice.links)
      if (owns(link.i)) lattice_.links.push_back({local(link.i), local(link.j), link.spring});
    for (const VolumeCell& cell : problem.lattice.volume_cells)
      if (owns(cell.nodes[0])) {
        lattice_.volume_cells.push_back(cell);
        for (int& node : lattice_.volume_cells.back().nodes) node = local(node);
      }
    for (PetscInt d = 3 * first_; d < 3 * (first_ + n_own_); ++d)
      if (problem.is_fixed[index(d)]) fixed_.push_back(d);
    moved_ = make_vector();
    force_ = make_vector();
    applied_ = make_vector();
    put(applied_.get(), problem.force);
    set_fixed(applied_.get(), nullptr);
  }

  petsc::Vector make_vector() const {
    Vec vector = nullptr;
    check(VecCreateGhostBlock(communicator_, 3, 3 * n_own_, PETSC_DECIDE,
                              static_cast<PetscInt>(ghosts_.size()), ghosts_.data(), &vector));
    return petsc::Vector(vector);
  }

  petsc::Matrix make_matrix() const {
    Mat matrix = nullptr;
    check(MatCreate(communicator_, &matrix));
    check(MatSetSizes(matrix, 3 * n_own_, 3 * n_own_, PETSC_DECIDE, PETSC_DECIDE));
    check(MatSetType(matrix, MATAIJ)); // GAMG's coarsening wants it, with its block size
    check(MatSetBlockSize(matrix, 3));
    std::vector<PetscInt> on_diagonal, elsewhere;
    count_neighbours(on_diagonal, elsewhere);
    check(MatXAIJSetPreallocation(matrix, 3, on_diagonal.data(), elsewhere.data(), nullptr, nullptr));
    check(MatSetOption(matrix, MAT_SYMMETRIC, PETSC_TRUE));
    check(MatSetOption(matrix, MAT_SPD,
                       PETSC_TRUE)); // where it is not, the pivots' signs or conjugate gradients tell
    petsc::attach_rigid_motions(matrix, lattice_.rest);
    return petsc::Matrix(matrix);
  }

  /// Owned entries of a vector from values of all points.
  void put(Vec vector, const Points& values) const {
    PetscScalar* entries = nullptr;
    check(VecGetArray(vector, &entries));
    for (PetscInt p = 0; p < n_own_; ++p)
      for (int c = 0; c < 3; ++c) entries[3 * p + c] = values[index(first_ + p)][c];
    check(VecRestoreArray(vector, &entries));
  }

  /// Values of all points, on every rank.
  Points gather(Vec vector) const {
    VecScatter scatter = nullptr;
    Vec all = nullptr;
    check(VecScatterCreateToAll(vector, &scatter, &all));
    const petsc::Vector owned(all);
    check(VecScatterBegin(scatter, vector, all, INSERT_VALUES, SCATTER_FORWARD));
    check(VecScatterEnd(scatter, vector, all, INSERT_VALUES, SCATTER_FORWARD));
    check(VecScatterDestroy(&scatter));
    const PetscScalar* entries = nullptr;
    check(VecGetArrayRead(all, &entries));
    Points values(problem_.lattice.rest.size());
    for (std::size_t p = 0; p < values.size(); ++p)
      values[p] = {entries[3 * p], entries[3 * p + 1], entries[3 * p + 2]};
    check(VecRestoreArrayRead(all, &entries));
    return values;
  }

  /// Sets the held degrees of freedom: to what the supports ask for, or to 0.
  void set_fixed(Vec vector, const Points* values) const {
    PetscScalar* entries = nullptr;
    check(VecGetArray(vector, &entries));
    for (const PetscInt d : fixed_)
      entries[d - 3 * first_] = values ? (*values)[index(d / 3)][static_cast<int>(d % 3)] : 0;
    check(VecRestoreArray(vector, &entries));
  }

  /// Minus the forces on the points at a displacement, N; where held, how far from where they should be, mm.
  /// SNES' function: it has the tangent as its derivative.
  PetscErrorCode residual(Vec displacement, Vec out) {
    PetscFunctionBeginUser;
    const Points positions = local_positions(displacement);
    const Points internal = internal_force(lattice_, positions);
    Vec local = nullptr;
    PetscScalar* entries = nullptr;
    PetscCall(VecGhostGetLocalForm(force_.get(), &local));
    PetscCall(VecGetArray(local, &entries));
    for (std::size_t p = 0; p < internal.size(); ++p)
      for (int c = 0; c < 3; ++c) entries[3 * p + static_cast<std::size_t>(c)] = -internal[p][c];
    PetscCall(VecRestoreArray(local, &entries));
    PetscCall(VecGhostRestoreLocalForm(force_.get(), &local));
    PetscCall(VecGhostUpdateBegin(force_.get(), ADD_VALUES, SCATTER_REVERSE));
    PetscCall(VecGhostUpdateEnd(force_.get(), ADD_VALUES, SCATTER_REVERSE));
    PetscCall(VecCopy(force_.get(), out));
    PetscCall(VecAXPY(out, -load_factor, applied_.get()));
    // An iterative solver moves the held points a little: the next step has to bring them back.
    Vec wanted = nullptr;
    PetscCall(VecDuplicate(displacement, &wanted));
    const petsc::Vector owned(wanted);
    PetscCall(VecCopy(displacement, wanted));
    move_supports(wanted);
    const PetscScalar *is = nullptr, *should_be = nullptr;
    PetscScalar* entries_out = nullptr;
    PetscCall(VecGetArrayRead(displacement, &is));
    PetscCall(VecGetArrayRead(wanted, &should_be));
    PetscCall(VecGetArray(out, &entries_out));
    for (const PetscInt d : fixed_)
      entries_out[d - 3 * first_] = is[d - 3 * first_] - should_be[d - 3 * first_];
    PetscCall(VecRestoreArray(out, &entries_out));
    PetscCall(VecRestoreArrayRead(wanted, &should_be));
    PetscCall(VecRestoreArrayRead(displacement, &is));
    PetscFunctionReturn(0);
  }

  PetscErrorCode tangent(Vec displacement, Mat matrix) {
    PetscFunctionBeginUser;
    PetscCall(MatZeroEntries(matrix));
    const auto add = [&](int row, int column, const Eigen::Matrix3d& block) {
      const auto put_block = [&](int i, int j, const Eigen::Matrix3d& values) {
        const PetscInt row_block = static_cast<PetscInt>(global(index(i))),
                       column_block = static_cast<PetscInt>(global(index(j)));
        const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> by_rows = values;
        check(MatSetValuesBlocked(matrix, 1, &row_block, 1, &column_block, by_rows.data(), ADD_VALUES));
      };
      put_block(row, column, block);
      if (row != column) put_block(column, row, block.transpose());
    };
    visit_tangent_blocks(lattice_, local_positions(displacement), TransverseTerm::exact, add);
    PetscCall(MatAssemblyBegin(matrix, MAT_FINAL_ASSEMBLY));
    PetscCall(MatAssemblyEnd(matrix, MAT_FINAL_ASSEMBLY));
    PetscCall(
        MatZeroRowsColumns(matrix, static_cast<PetscInt>(fixed_.size()), fixed_.data(), 1, nullptr, nullptr));
    PetscFunctionReturn(0);
  }

  /// What imbalances are measured against: the norm of the applied forces, N; 1 when there are none.
  double reference_force() const {
    PetscReal norm = 0;
    check(VecNorm(applied_.get(), NORM_2, &norm));
    return norm > 0 ? norm : 1;
  }

  void move_supports(Vec displacement) const {
    if (!problem_.supports) return set_fixed(displacement, nullptr);
    const Points supports = problem_.supports(load_factor);
    set_fixed(displacement, &supports);
  }

  double load_factor = 0;

 private:
  const Problem& problem_;
  MPI_Comm communicator_;
  PetscInt first_ = 0, n_own_ = 0;
  std::vector<PetscInt> ghosts_; ///< ascending
  std::vector<PetscInt> fixed_;  ///< owned degrees of freedom
  Lattice lattice_;              ///< in local numbers
  petsc::Vector moved_, force_, applied_;

  bool owns(int point) const { return point >= first_ && point < first_ + n_own_; }
  PetscInt global(std::size_t local) const {
    return local < index(n_own_) ? first_ + static_cast<PetscInt>(local) : ghosts_[local - index(n_own_)];
  }
  int local(int point) const {
    if (owns(point)) return point - static_cast<int>(first_);
    const auto at = std::lower_bound(ghosts_.begin(), ghosts_.end(), point);
    return static_cast<int>(n_own_ + (at - ghosts_.begin()));
  }

  void deal_out() {
    const auto n_points = static_cast<PetscInt>(problem_.lattice.rest.size());
    n_own_ = PETSC_DECIDE;
    PetscInt all = n_points, end = 0;
    check(PetscSplitOwnership(communicator_, &n_own_, &all));
    MPI_Scan(&n_own_, &end, 1, MPIU_INT, MPI_SUM, communicator_);
    first_ = end - n_own_;
    std::set<PetscInt> touched;
    for (const Link& link : problem_.lattice.links)
      if (owns(link.i) && !owns(link.j)) touched.insert(link.j);
    for (const VolumeCell& cell : problem_.lattice.volume_cells)
      if (owns(cell.nodes[0]))
        for (const int node : cell.nodes)
          if (!owns(node)) touched.insert(node);
    ghosts_.assign(touched.begin(), touched.end());
  }

  /// Blocks in the rows of the own points, in the columns of own points and of others'.
  void count_neighbours(std::vector<PetscInt>& on_diagonal, std::vector<PetscInt>& elsewhere) const {
    std::vector<std::set<int>> neighbours(index(n_own_));
    const auto join = [&](int i, int j) {
      if (owns(i)) neighbours[index(i - first_)].insert(j);
    };
    for (const Link& link : problem_.lattice.links) {
      join(link.i, link.j);
      join(link.j, link.i);
    }
    for (const VolumeCell& cell : problem_.lattice.volume_cells)
      for (const int i : cell.nodes)
        for (const int j : cell.nodes) join(i, j);
    for (std::size_t p = 0; p < neighbours.size(); ++p) {
      neighbours[p].insert(static_cast<int>(first_) + static_cast<int>(p));
      const auto own =
          std::count_if(neighbours[p].begin(), neighbours[p].end(), [&](int j) { return owns(j); });
      on_diagonal.push_back(static_cast<PetscInt>(own));
      elsewhere.push_back(static_cast<PetscInt>(neighbours[p].size()) - static_cast<PetscInt>(own));
    }
  }

  Points local_positions(Vec displacement) const {
    Vec local = nullptr;
    const PetscScalar* entries = nullptr;
    check(VecCopy(displacement, moved_.get()));
    check(VecGhostUpdateBegin(moved_.get(), INSERT_VALUES, SCATTER_FORWARD));
    check(VecGhostUpdateEnd(moved_.get(), INSERT_VALUES, SCATTER_FORWARD));
    check(VecGhostGetLocalForm(moved_.get(), &local));
    check(VecGetArrayRead(local, &entries));
    Points positions = lattice_.rest;
    for (std::size_t p = 0; p < positions.size(); ++p)
      positions[p] += Eigen::Vector3d(entries[3 * p], entries[3 * p + 1], entries[3 * p + 2]);
    check(VecRestoreArrayRead(local, &entries));
    check(VecGhostRestoreLocalForm(moved_.get(), &local));
    return positions;
  }
};

PetscErrorCode evaluate_residual(SNES, Vec x, Vec out, void* part) {
  return static_cast<Part*>(part)->residual(x, out);
}
PetscErrorCode evaluate_tangent(SNES, Vec x, Mat matrix, Mat, void* part) {
  return static_cast<Part*>(part)->tangent(x, matrix);
}

/// SNES set up for a part; what it points to must outlive it.
petsc::NonlinearSolver make_solver(Part& part, Mat matrix, Vec residual, const EquilibriumSettings& settings,
                                   MPI_Comm communicator) {
  SNES snes = nullptr;
  SNESLineSearch line_search = nullptr;
  KSP linear = nullptr;
  PC preconditioner = nullptr;
  check(SNESCreate(communicator, &snes));
  petsc::NonlinearSolver owned(snes);
  check(SNESSetOptionsPrefix(snes, "msm_"));
  check(SNESSetFunction(snes, residual, evaluate_residual, &part));
  check(SNESSetJacobian(snes, matrix, matrix, evaluate_tangent, &part));
  check(SNESSetType(snes, SNESNEWTONLS));
  check(SNESGetLineSearch(snes, &line_search));
  // On the imbalance: next to the solution the potential's change drowns in rounding, and PETSc's search with
  // it.
  check(SNESLineSearchSetType(line_search, SNESLINESEARCHBT));
  check(SNESSetTolerances(snes, settings.tolerance * part.reference_force(), 0, 0,
                          settings.max_newton_per_step, PETSC_DEFAULT));
  check(SNESGetKSP(snes, &linear));
  check(KSPGetPC(linear, &preconditioner));
  PetscInt n_unknowns = 0;
  check(MatGetSize(matrix, &n_unknowns, nullptr));
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
  return owned;
}

/// Whether the tangent that the solver was last used with is positive definite: by the factorisation's
/// pivots, or by conjugate gradients for a random right side, which has a part in every mode, meeting no
/// negative curvature.
bool is_definite(SNES snes, Mat matrix, Vec displacement, Part& part) {
  KSP linear = nullptr;
  PC preconditioner = nullptr;
  PetscBool is_direct = PETSC_FALSE;
  check(SNESGetKSP(snes, &linear));
  check(KSPGetPC(linear, &preconditioner));
  check(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(preconditioner), PCCHOLESKY, &is_direct));
  check(part.tangent(displacement, matrix));
  Vec right = nullptr, solution = nullptr;
  check(MatCreateVecs(matrix, &solution, &right));
  const petsc::Vector owned_right(right), owned_solution(solution);
  PetscInt first = 0, last = 0;
  check(VecGetOwnershipRange(right, &first, &last));
  std::mt19937 generator(3u + static_cast<unsigned>(first));
  std::normal_distribution<double> normal;
  for (PetscInt d = first; d < last; ++d) check(VecSetValue(right, d, normal(generator), INSERT_VALUES));
  check(VecAssemblyBegin(right));
  check(VecAssemblyEnd(right));
  check(KSPSetOperators(linear, matrix, matrix));
  if (!is_direct) check(KSPSetTolerances(linear, 1e-6, PETSC_DEFAULT, PETSC_DEFAULT, 1000));
  check(KSPSolve(linear, right, solution));
  KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
  check(KSPGetConvergedReason(linear, &reason));
  if (!is_direct || reason <= 0) return reason > 0;
  Mat factor = nullptr;
  PetscInt negative = 0;
  check(PCFactorGetMatrix(preconditioner, &factor));
  check(MatMumpsGetInfog(factor, 12, &negative));
  return negative == 0;
}

/// One load step from `trial`, which on success is its end. Counts what it took.
bool attempt(SNES snes, Part& part, Vec trial, double load_factor, cases::Solution& count) {
  part.load_factor = load_factor;
  part.move_supports(trial);
  check(SNESSolve(snes, nullptr, trial));
  SNESConvergedReason reason = SNES_CONVERGED_ITERATING;
  PetscInt newton = 0, linear = 0;
  check(SNESGetConvergedReason(snes, &reason));
  check(SNESGetIterationNumber(snes, &newton));
  check(SNESGetLinearSolveIterations(snes, &linear));
  count.newton_iterations += static_cast<int>(newton);
  count.linear_iterations += linear;
  return reason > 0;
}

} // namespace

cases::Solution solve_by_snes(const cases::Scene& scene, const std::vector<CellStiffness>& stiffness,
                              MPI_Comm communicator, const EquilibriumSettings& settings,
                              const Points& start) {
  Problem problem = make_problem(scene);
  problem.lattice = make_lattice(scene.mesh, stiffness);
  Part part(problem, communicator);
  const petsc::Vector now = part.make_vector(), trial = part.make_vector(), residual = part.make_vector();
  const petsc::Matrix matrix = part.make_matrix();
  if (!start.empty()) part.put(now.get(), start);
  const petsc::NonlinearSolver snes = make_solver(part, matrix.get(), residual.get(), settings, communicator);
  cases::Solution solution;
  double step = settings.first_load_step;
  for (int n = 0; solution.load_reached < 1; ++n) {
    if (n == settings.max_load_steps)
      throw cases::SolveError("mass-spring equilibrium by SNES: the limit on load steps was reached",
                              solution.load_reached, 1);
    if (step < settings.smallest_load_step)
      throw cases::SolveError("mass-spring equilibrium by SNES: no equilibrium was found beyond this load",
                              solution.load_reached, 1, cases::Outcome::limit_point);
    const double target = std::min(1.0, solution.load_reached + step);
    check(VecCopy(now.get(), trial.get()));
    const bool ends_well =
        attempt(snes.get(), part, trial.get(), target, solution) &&
        (settings.stability == Stability::ignore || is_definite(snes.get(), matrix.get(), trial.get(), part));
    if (!ends_well) { // the path from rest is one of stable equilibria
      step /= 2;
      continue;
    }
    check(VecCopy(trial.get(), now.get()));
    solution.load_reached = target;
    step = std::min(2 * step, settings.largest_load_step);
  }
  PetscReal norm = 0;
  check(part.residual(now.get(), residual.get()));
  check(VecNorm(residual.get(), NORM_2, &norm));
  solution.residual = norm / part.reference_force();
  solution.status = cases::Status::converged;
  solution.outcome =
      settings.stability == Stability::require || is_definite(snes.get(), matrix.get(), now.get(), part)
          ? cases::Outcome::stable_equilibrium
          : cases::Outcome::unstable_equilibrium;
  solution.unknowns =
      static_cast<std::size_t>(std::count(problem.is_fixed.begin(), problem.is_fixed.end(), false));
  solution.displacement = part.gather(now.get());
  measure_cells(scene.mesh, solution);
  return solution;
}

} // namespace springproof::msm
