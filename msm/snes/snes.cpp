#include "msm/snes/snes.hpp"

#include "mechanics/equilibrium/newton.hpp"
#include "mechanics/equilibrium/turns.hpp"
#include "mechanics/petsc/distributed_problem.hpp"
#include "mechanics/petsc/handles.hpp"
#include "mechanics/ranks/share_out.hpp"
#include "msm/model.hpp"
#include "msm/snes/deal_out.hpp"
#include "msm/tangent.hpp"

#include <algorithm>
#include <random>
#include <set>

namespace springproof::msm {

using cases::index;
using mechanics::petsc::check;
using mechanics::petsc::ReadEntries;
using mechanics::petsc::WriteEntries;
namespace petsc = mechanics::petsc;

namespace {

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
    for (const Tetrahedron& tetrahedron : problem.lattice.tetrahedra)
      if (owns(tetrahedron.nodes[0])) {
        lattice_.tetrahedra.push_back(tetrahedron);
        for (int& node : lattice_.tetrahedra.back().nodes) node = local(node);
      }
    for (PetscInt d = 3 * first_; d < 3 * (first_ + n_own_); ++d)
      if (problem.is_constrained[index(d)]) constrained_.push_back(d);
    moved_ = make_vector();
    force_ = make_vector();
    applied_ = make_vector();
    put(applied_.get(), own(problem.on_all_points(problem.force)));
    const WriteEntries applied(applied_.get());
    for (const PetscInt d : constrained_) applied[d - 3 * first_] = 0;
  }

  std::size_t n_unknowns() const { return msm::n_unknowns(problem_); }

  petsc::Vector make_vector() const {
    const auto n_ghosts = static_cast<PetscInt>(ghosts_.size());
    return petsc::Vector(petsc::get<Vec>(VecCreateGhostBlock, communicator_, 3, 3 * n_own_, PETSC_DECIDE,
                                         n_ghosts, ghosts_.data()));
  }

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
    add_tangent(lattice_.rest, sparsity.get());
    check(MatPreallocatorPreallocate(sparsity.get(), PETSC_TRUE, matrix.get()));
    check(MatSetOption(matrix.get(), MAT_SYMMETRIC, PETSC_TRUE));
    // Where it is not definite, the pivots' signs or conjugate gradients tell.
    check(MatSetOption(matrix.get(), MAT_SPD, PETSC_TRUE));
    petsc::attach_rigid_motions(matrix.get(), lattice_.rest);
    return matrix;
  }

  /// This rank's entries of values of all points.
  Vector own(const Points& values) const {
    return Eigen::Map<const Vector>(values.front().data() + 3 * first_, 3 * n_own_);
  }

  /// Of the points that this rank owns to those that it shows of the answer.
  Points deal(const Vector& own, const cases::Sharing* sharing) const {
    std::vector<cases::Numbered<Eigen::Vector3d>> values;
    for (PetscInt p = 0; p < n_own_; ++p) values.push_back({first_ + p, own.segment<3>(3 * p)});
    return cases::deal(sharing, std::move(values), problem_.lattice.rest.size(), Eigen::Vector3d(0, 0, 0));
  }

  /// Between PETSc's vectors and the driver's: owned entries.
  void put(Vec vector, const Vector& own) const {
    std::copy(own.begin(), own.end(), WriteEntries(vector).data());
  }
  Vector own(Vec vector) const { return Eigen::Map<const Vector>(ReadEntries(vector).data(), 3 * n_own_); }

  /// Minus the forces on the points at a displacement, N; of constrained degrees of freedom how far they are
  /// from where they should be, mm. SNES' function: it has the tangent as its derivative.
  void residual(Vec displacement, double load_factor, Vec out) const {
    const Points internal = internal_force_at(lattice_, local_displacement(displacement));
    {
      const WriteEntries force(force_.get());
      for (std::size_t p = 0; p < internal.size(); ++p)
        for (int c = 0; c < 3; ++c) force[3 * p + static_cast<std::size_t>(c)] = -internal[p][c];
    }
    petsc::add_ghosts(force_.get());
    check(VecCopy(force_.get(), out));
    check(VecAXPY(out, -load_factor, applied_.get()));
    // An iterative solver moves the supports a little: the next step has to bring them back.
    const ReadEntries is(displacement);
    const WriteEntries entries(out);
    for_each_constrained(load_factor,
                         [&](PetscInt d, double prescribed) { entries[d] = is[d] - prescribed; });
  }

  void tangent(Vec displacement, Mat matrix) const {
    check(MatZeroEntries(matrix));
    Points positions = local_displacement(displacement);
    for (std::size_t p = 0; p < positions.size(); ++p) positions[p] += lattice_.rest[p];
    add_tangent(positions, matrix);
    check(MatZeroRowsColumns(matrix, static_cast<PetscInt>(constrained_.size()), constrained_.data(), 1,
                             nullptr, nullptr));
  }

  /// Sets the constrained degrees of freedom.
  void move_supports(Vec displacement, double load_factor) const {
    const WriteEntries entries(displacement);
    for_each_constrained(load_factor, [&](PetscInt d, double prescribed) { entries[d] = prescribed; });
  }

  /// What residuals are measured against: the norm of the applied forces, N; 1 when there are none.
  double reference_force() const {
    const auto norm = petsc::get<PetscReal>(VecNorm, applied_.get(), NORM_2);
    return norm > 0 ? norm : 1;
  }

 private:
  const Problem& problem_;
  MPI_Comm communicator_;
  PetscInt first_ = 0, n_own_ = 0;
  std::vector<PetscInt> ghosts_;      ///< ascending
  std::vector<PetscInt> constrained_; ///< owned degrees of freedom
  Lattice lattice_;                   ///< in local numbers
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
    n_own_ = PETSC_DECIDE;
    PetscInt all = static_cast<PetscInt>(problem_.lattice.rest.size()), end = 0;
    check(PetscSplitOwnership(communicator_, &n_own_, &all));
    MPI_Scan(&n_own_, &end, 1, MPIU_INT, MPI_SUM, communicator_);
    first_ = end - n_own_;
    std::set<PetscInt> touched;
    for (const Link& link : problem_.lattice.links)
      if (owns(link.i) && !owns(link.j)) touched.insert(link.j);
    const auto touch = [&](const auto& nodes) {
      if (owns(nodes[0]))
        for (const int node : nodes)
          if (!owns(node)) touched.insert(node);
    };
    for (const VolumeCell& cell : problem_.lattice.volume_cells) touch(cell.nodes);
    for (const Tetrahedron& tetrahedron : problem_.lattice.tetrahedra) touch(tetrahedron.nodes);
    ghosts_.assign(touched.begin(), touched.end());
  }

  void add_tangent(const Points& positions, Mat matrix) const {
    const auto add = [&](int i, int j, const Eigen::Matrix3d& block) {
      const PetscInt row = global(index(i)), column = global(index(j));
      const Eigen::Matrix3d transposed = block.transpose(); // PETSc wants rows, Eigen stores columns
      check(MatSetValuesBlocked(matrix, 1, &row, 1, &column, transposed.data(), ADD_VALUES));
      if (i != j) check(MatSetValuesBlocked(matrix, 1, &column, 1, &row, block.data(), ADD_VALUES));
    };
    visit_tangent_blocks(lattice_, positions, TransverseTerm::exact, add);
    check(MatAssemblyBegin(matrix, MAT_FINAL_ASSEMBLY));
    check(MatAssemblyEnd(matrix, MAT_FINAL_ASSEMBLY));
  }

  Points local_displacement(Vec displacement) const {
    check(VecCopy(displacement, moved_.get()));
    petsc::update_ghosts(moved_.get());
    const ReadEntries entries(moved_.get());
    Points local(lattice_.rest.size());
    for (std::size_t p = 0; p < local.size(); ++p)
      local[p] = Eigen::Vector3d(entries[3 * p], entries[3 * p + 1], entries[3 * p + 2]);
    return local;
  }

  /// Calls action(entry among the owned ones, prescribed displacement in mm) for constrained ones.
  template<class Action>
  void for_each_constrained(double load_factor, const Action& action) const {
    const Points supports =
        problem_.supports ? problem_.on_all_points(problem_.supports(load_factor)) : Points{};
    for (const PetscInt d : constrained_)
      action(d - 3 * first_, supports.empty() ? 0 : supports[index(d / 3)][static_cast<int>(d % 3)]);
  }
};

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
  Points displacement(const Vector& state, const cases::Sharing* sharing) const {
    return part_.deal(state, sharing);
  }

  std::optional<Solved> solve_at(Vector& at, double load_factor) override {
    load_factor_ = load_factor;
    part_.put(at_.get(), at);
    part_.move_supports(at_.get(), load_factor);
    errors_.call([&] { return SNESSolve(snes_.get(), nullptr, at_.get()); });
    work_.linear_iterations += petsc::get<PetscInt>(SNESGetLinearSolveIterations, snes_.get());
    petsc::check_memory_of(petsc::get<KSP>(SNESGetKSP, snes_.get()));
    at = part_.own(at_.get());
    return Solved{petsc::get<SNESConvergedReason>(SNESGetConvergedReason, snes_.get()) > 0,
                  petsc::get<PetscInt>(SNESGetIterationNumber, snes_.get()),
                  petsc::get<PetscReal>(SNESGetFunctionNorm, snes_.get()) / part_.reference_force()};
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
  bool direction(const Vector&, const Vector&, double, double, mechanics::Convexity, Vector&) override {
    return false; // solve_at() does it all
  }
  mechanics::Merit merit() const override { return mechanics::Merit::none; }
  Work work() const override { return work_; }
  std::size_t n_unknowns() const override { return part_.n_unknowns(); }

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
