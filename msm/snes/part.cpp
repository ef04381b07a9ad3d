#include "msm/snes/part.hpp"

#include "cases/case/index.hpp"
#include "msm/tangent.hpp"

#include <algorithm>
#include <set>

namespace springproof::msm {

using cases::index;
using mechanics::petsc::check;
using mechanics::petsc::ReadEntries;
using mechanics::petsc::WriteEntries;
namespace petsc = mechanics::petsc;

Part::Part(const Problem& problem, MPI_Comm communicator) : problem_(problem), communicator_(communicator) {
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
    if (problem.is_constrained[index(d)]) constrained_.push_back(d);
  moved_ = make_vector();
  force_ = make_vector();
  applied_ = make_vector();
  put(applied_.get(), own(problem.force));
  const WriteEntries applied(applied_.get());
  for (const PetscInt d : constrained_) applied[d - 3 * first_] = 0;
}

void Part::deal_out() {
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

petsc::Vector Part::make_vector() const {
  Vec vector = nullptr;
  check(VecCreateGhostBlock(communicator_, 3, 3 * n_own_, PETSC_DECIDE, static_cast<PetscInt>(ghosts_.size()),
                            ghosts_.data(), &vector));
  return petsc::Vector(vector);
}

petsc::Matrix Part::make_matrix() const {
  const auto create = [&](MatType type) {
    Mat made = nullptr;
    check(MatCreate(communicator_, &made));
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

PetscInt Part::global(std::size_t local) const {
  return local < index(n_own_) ? first_ + static_cast<PetscInt>(local) : ghosts_[local - index(n_own_)];
}

int Part::local(int point) const {
  if (owns(point)) return point - static_cast<int>(first_);
  const auto at = std::lower_bound(ghosts_.begin(), ghosts_.end(), point);
  return static_cast<int>(n_own_ + (at - ghosts_.begin()));
}

void Part::put(Vec vector, const Vector& own) const {
  std::copy(own.begin(), own.end(), WriteEntries(vector).data());
}

Vector Part::own(Vec vector) const {
  return Eigen::Map<const Vector>(ReadEntries(vector).data(), 3 * n_own_);
}

Vector Part::own(const Points& values) const {
  return Eigen::Map<const Vector>(values.front().data() + 3 * first_, 3 * n_own_);
}

Points Part::gather(Vec vector) const {
  VecScatter scatter = nullptr;
  Vec all = nullptr;
  check(VecScatterCreateToAll(vector, &scatter, &all));
  const petsc::Vector owned(all);
  check(VecScatterBegin(scatter, vector, all, INSERT_VALUES, SCATTER_FORWARD));
  check(VecScatterEnd(scatter, vector, all, INSERT_VALUES, SCATTER_FORWARD));
  check(VecScatterDestroy(&scatter));
  Points values(problem_.lattice.rest.size());
  std::copy_n(ReadEntries(all).data(), 3 * values.size(), values.front().data());
  return values;
}

template<class Action>
void Part::for_each_constrained(double load_factor, const Action& action) const {
  const Points supports = problem_.supports ? problem_.supports(load_factor) : Points{};
  for (const PetscInt d : constrained_)
    action(d - 3 * first_, supports.empty() ? 0 : supports[index(d / 3)][static_cast<int>(d % 3)]);
}

void Part::move_supports(Vec displacement, double load_factor) const {
  const WriteEntries entries(displacement);
  for_each_constrained(load_factor, [&](PetscInt d, double prescribed) { entries[d] = prescribed; });
}

Points Part::local_positions(Vec displacement) const {
  check(VecCopy(displacement, moved_.get()));
  petsc::update_ghosts(moved_.get());
  const ReadEntries entries(moved_.get());
  Points positions = lattice_.rest;
  for (std::size_t p = 0; p < positions.size(); ++p)
    positions[p] += Eigen::Vector3d(entries[3 * p], entries[3 * p + 1], entries[3 * p + 2]);
  return positions;
}

void Part::residual(Vec displacement, double load_factor, Vec out) const {
  const Points internal = internal_force(lattice_, local_positions(displacement));
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
  for_each_constrained(load_factor, [&](PetscInt d, double prescribed) { entries[d] = is[d] - prescribed; });
}

void Part::add_tangent(const Points& positions, Mat matrix) const {
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

void Part::tangent(Vec displacement, Mat matrix) const {
  check(MatZeroEntries(matrix));
  add_tangent(local_positions(displacement), matrix);
  check(MatZeroRowsColumns(matrix, static_cast<PetscInt>(constrained_.size()), constrained_.data(), 1,
                           nullptr, nullptr));
}

double Part::reference_force() const {
  const auto norm = petsc::get<PetscReal>(VecNorm, applied_.get(), NORM_2);
  return norm > 0 ? norm : 1;
}

} // namespace springproof::msm
