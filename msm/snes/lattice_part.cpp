#include "msm/snes/lattice_part.hpp"

#include "cases/mesh/sharing.hpp"
#include "msm/tangent.hpp"

#include <algorithm>
#include <set>

namespace springproof::msm {

using cases::index;
using mechanics::petsc::check;
using mechanics::petsc::ReadEntries;
using mechanics::petsc::WriteEntries;
namespace petsc = mechanics::petsc;

LatticePart::LatticePart(const Problem& problem, MPI_Comm communicator)
    : problem_(problem), communicator_(communicator) {
  deal_out();
  lattice_ = part_of(problem.lattice);
  for (PetscInt d = 3 * first_; d < 3 * (first_ + n_own_); ++d)
    if (problem.is_constrained[index(d)]) constrained_.push_back(d);
  moved_ = make_vector();
  gradient_ = make_vector();
  applied_ = make_vector();
  Vector applied = own(problem.on_all_points(problem.force));
  for_each_constrained([&](PetscInt entry) { applied[entry] = 0; });
  put(applied_.get(), applied);
}

Lattice LatticePart::part_of(const Lattice& whole) const {
  Lattice part;
  part.rest.resize(index(n_own_) + ghosts_.size());
  for (std::size_t local = 0; local < part.rest.size(); ++local)
    part.rest[local] = whole.rest[index(global(local))];
  for (const Link& link : whole.links)
    if (owns(link.i)) part.links.push_back({local(link.i), local(link.j), link.spring});
  const auto take = [&](const auto& cells, auto& own_cells) {
    for (const auto& cell : cells) {
      if (!owns(cell.nodes[0])) continue;
      own_cells.push_back(cell);
      for (int& node : own_cells.back().nodes) node = local(node);
    }
  };
  take(whole.volume_cells, part.volume_cells);
  take(whole.tetrahedra, part.tetrahedra);
  return part;
}

void LatticePart::deal_out() {
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

PetscInt LatticePart::global(std::size_t local) const {
  return local < index(n_own_) ? first_ + static_cast<PetscInt>(local) : ghosts_[local - index(n_own_)];
}

int LatticePart::local(int point) const {
  if (owns(point)) return point - static_cast<int>(first_);
  const auto at = std::lower_bound(ghosts_.begin(), ghosts_.end(), point);
  return static_cast<int>(n_own_ + (at - ghosts_.begin()));
}

petsc::Vector LatticePart::make_vector() const {
  const auto n_ghosts = static_cast<PetscInt>(ghosts_.size());
  return petsc::Vector(petsc::get<Vec>(VecCreateGhostBlock, communicator_, 3, 3 * n_own_, PETSC_DECIDE,
                                       n_ghosts, ghosts_.data()));
}

petsc::Matrix LatticePart::make_matrix() const {
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
  petsc::attach_rigid_motions(matrix.get(), lattice_.rest);
  return matrix;
}

Vector LatticePart::own(const Points& values) const {
  return Eigen::Map<const Vector>(values.front().data() + 3 * first_, 3 * n_own_);
}

Points LatticePart::deal(const Vector& own, const cases::Sharing* sharing) const {
  std::vector<cases::Numbered<Eigen::Vector3d>> values;
  for (PetscInt p = 0; p < n_own_; ++p) values.push_back({first_ + p, own.segment<3>(3 * p)});
  return cases::deal(sharing, std::move(values), problem_.lattice.rest.size(), Eigen::Vector3d(0, 0, 0));
}

void LatticePart::put(Vec vector, const Vector& own) const {
  std::copy(own.begin(), own.end(), WriteEntries(vector).data());
}

Vector LatticePart::own(Vec vector) const {
  return Eigen::Map<const Vector>(ReadEntries(vector).data(), 3 * n_own_);
}

void LatticePart::residual(Vec displacement, double load_factor, Vec out) const {
  const Points force = internal_force_at(lattice_, local_displacement(displacement));
  {
    const WriteEntries gradient(gradient_.get());
    for (std::size_t p = 0; p < force.size(); ++p)
      for (int c = 0; c < 3; ++c) gradient[3 * p + static_cast<std::size_t>(c)] = -force[p][c];
  }
  petsc::add_ghosts(gradient_.get());
  check(VecCopy(gradient_.get(), out));
  check(VecAXPY(out, -load_factor, applied_.get()));
  // An iterative solver moves the supports a little: the next step has to bring them back.
  const ReadEntries is(displacement);
  const WriteEntries entries(out);
  const Points prescribed = supports(load_factor);
  for_each_constrained([&](PetscInt entry) { entries[entry] = is[entry] - at(prescribed, entry); });
}

void LatticePart::tangent(Vec displacement, Mat matrix) const {
  check(MatZeroEntries(matrix));
  Points positions = local_displacement(displacement);
  for (std::size_t p = 0; p < positions.size(); ++p) positions[p] += lattice_.rest[p];
  add_tangent(positions, matrix);
  check(MatZeroRowsColumns(matrix, static_cast<PetscInt>(constrained_.size()), constrained_.data(), 1,
                           nullptr, nullptr));
}

void LatticePart::move_supports(Vector& displacement, double load_factor) const {
  const Points prescribed = supports(load_factor);
  for_each_constrained([&](PetscInt entry) { displacement[entry] = at(prescribed, entry); });
}

/// Where they are, mm, one per point of all; empty: where they were at rest.
Points LatticePart::supports(double load_factor) const {
  return problem_.supports ? problem_.on_all_points(problem_.supports(load_factor)) : Points{};
}

double LatticePart::at(const Points& of_supports, PetscInt entry) const {
  const PetscInt d = 3 * first_ + entry;
  return of_supports.empty() ? 0 : of_supports[index(d / 3)][static_cast<int>(d % 3)];
}

double LatticePart::reference_force() const {
  const auto norm = petsc::get<PetscReal>(VecNorm, applied_.get(), NORM_2);
  return norm > 0 ? norm : 1;
}

void LatticePart::add_tangent(const Points& positions, Mat matrix) const {
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

Points LatticePart::local_displacement(Vec displacement) const {
  check(VecCopy(displacement, moved_.get()));
  petsc::update_ghosts(moved_.get());
  const ReadEntries entries(moved_.get());
  Points local(lattice_.rest.size());
  for (std::size_t p = 0; p < local.size(); ++p)
    local[p] = Eigen::Vector3d(entries[3 * p], entries[3 * p + 1], entries[3 * p + 2]);
  return local;
}

} // namespace springproof::msm
