#include "msm/grid/spring_field.hpp"

#include "cases/case/index.hpp"

#include <Eigen/LU>

namespace springproof::msm::grid {

namespace {

using cases::index;

/// Planes of nodes are dealt out in slabs of some sixteen: the same on any number of threads, so that sums
/// are too, and an even number, so that two threads have the same to do.
int slabs_of(int planes) {
  return planes < 8 ? 1 : 2 * std::max(1, planes / 16);
}

/// First plane of slab s of n.
int first_plane(int s, int n, int planes) {
  return static_cast<int>(std::ptrdiff_t{s} * planes / n);
}

struct Step {
  int dx, dy, dz;
};

Step step_of(int spring) {
  if (spring == 12) return {1, 0, 0};
  return {spring % 3 - 1, group_dy[spring / 3], group_dz[spring / 3]};
}

/// Stiffness of the spring of one cell that leads along a step.
double stiffness_along(const CellSprings& cell, const Step& step) {
  const bool x = step.dx != 0, y = step.dy != 0, z = step.dz != 0;
  if (x && y && z) return cell.internal_diagonal;
  if (y && z) return cell.face_diagonal[0];
  if (x && z) return cell.face_diagonal[1];
  if (x && y) return cell.face_diagonal[2];
  return cell.edge[x ? 0 : y ? 1 : 2];
}

} // namespace

template<class Real>
SpringField<Real>::SpringField(const Body& body, int n_threads)
    : body_(body), n_threads_(n_threads), springs_{} {
  springs_.layout = body.layout;
  springs_.rest_volume = static_cast<Real>(body.spacing.prod());
  for (int s = 0; s < n_springs; ++s) {
    const Step step = step_of(s);
    const Eigen::Vector3d rest = Eigen::Vector3d(step.dx, step.dy, step.dz).cwiseProduct(body.spacing);
    for (int a = 0; a < 3; ++a) springs_.rest[s][a] = static_cast<Real>(rest[a]);
    springs_.rest_length[s] = static_cast<Real>(rest.norm());
  }
  if (body.is_uniform())
    set_shares();
  else
    set_by_node();
  bool has_volume = false;
  for (const CellSprings& cell : body.springs) has_volume = has_volume || cell.volume != 0;
  if (has_volume) {
    Field<Real>& stiffness = arrays_.emplace_back(Field<Real>::Zero(body.layout.size));
    for (int k = 0; k < body.cells[2]; ++k)
      for (int j = 0; j < body.cells[1]; ++j)
        for (int i = 0; i < body.cells[0]; ++i)
          stiffness[body.layout.at(i, j, k)] =
              static_cast<Real>(body.cell(i, j, k).volume / body.spacing.prod());
    springs_.volume_stiffness = stiffness.data();
  }
  spill_.assign(index(n_slabs()), Field<Real>::Zero(6 * body.layout.plane + body.layout.lead + 32));
  scratch_.assign(index(n_slabs()), Field<Real>::Zero(scratch_size(body.layout)));
}

template<class Real>
void SpringField<Real>::set_shares() {
  for (int s = 0; s < n_springs; ++s)
    springs_.stiffness[s] = static_cast<Real>(stiffness_along(body_.springs.front(), step_of(s)));
  const Layout& layout = springs_.layout;
  const auto share_along = [&](int axis, int d, int i) {
    const int n = layout.nodes[axis];
    if (d == 0) return Real(i == 0 || i == n - 1 ? 1 : 2);
    return Real(i + d >= 0 && i + d < n ? 1 : 0);
  };
  Field<Real>& share = arrays_.emplace_back(Field<Real>::Zero(9 * layout.plane));
  Field<Real>& share_z = arrays_.emplace_back(3 * layout.nodes[2]);
  for (int d = -1; d <= 1; ++d) {
    for (int k = 0; k < layout.nodes[2]; ++k) share_z[3 * k + d + 1] = share_along(2, d, k);
    for (int e = -1; e <= 1; ++e)
      for (int j = 0; j < layout.nodes[1]; ++j)
        for (int i = 0; i < layout.nodes[0]; ++i)
          share[(3 * (e + 1) + d + 1) * layout.plane + i + layout.row * j] =
              share_along(0, d, i) * share_along(1, e, j);
  }
  springs_.share = share.data();
  springs_.share_z = share_z.data();
}

/// A spring gets what every cell with both its ends brings.
template<class Real>
void SpringField<Real>::set_by_node() {
  const Layout& layout = springs_.layout;
  Field<Real>& stiffness =
      arrays_.emplace_back(Field<Real>::Zero(n_springs * layout.nodes[2] * layout.plane));
  springs_.by_node = stiffness.data();
  for (int s = 0; s < n_springs; ++s) {
    springs_.stiffness[s] = 1;
    const Step step = step_of(s);
    const auto lowest = [](int d) { return d > 0 ? 0 : -1; }; // cells with both ends along an axis: these ...
    const auto highest = [](int d) { return d < 0 ? -1 : 0; }; // ... to these, counted from the node
    for (int k = 0; k < layout.nodes[2]; ++k)
      for (int j = 0; j < layout.nodes[1]; ++j)
        for (int i = 0; i < layout.nodes[0]; ++i) {
          double sum = 0;
          for (int c = lowest(step.dz); c <= highest(step.dz); ++c)
            for (int b = lowest(step.dy); b <= highest(step.dy); ++b)
              for (int a = lowest(step.dx); a <= highest(step.dx); ++a)
                sum += stiffness_along(body_.cell(i + a, j + b, k + c), step);
          stiffness[(n_springs * k + s) * layout.plane + i + layout.row * j] = static_cast<Real>(sum);
        }
  }
}

template<class Real>
int SpringField<Real>::n_slabs() const {
  return slabs_of(springs_.layout.nodes[2]);
}

/// Runs a kernel over the slabs and then adds every slab's spill to the plane it belongs to.
template<class Real>
template<class Run>
void SpringField<Real>::for_each_slab(int components, Real* result, const Run& run) const {
  const Layout& layout = springs_.layout;
  const int n = n_slabs();
#pragma omp parallel num_threads(n_threads_) if (n_threads_ > 1 && springs_.layout.size > piece)
  {
#pragma omp for schedule(static)
    for (int s = 0; s < n; ++s) {
      const Slab<Real> slab{first_plane(s, n, layout.nodes[2]), first_plane(s + 1, n, layout.nodes[2]),
                            spill_[index(s)].data(), scratch_[index(s)].data()};
      run(slab);
    }
#pragma omp for schedule(static)
    for (int s = 0; s < n - 1; ++s)
      for (int c = 0; c < components; ++c) {
        Real* plane = result + c * layout.size + layout.at(0, 0, first_plane(s + 1, n, layout.nodes[2])) -
                      layout.at(0, 0, -1);
        const Real* spill = spill_[index(s)].data() + c * layout.plane;
        for (std::ptrdiff_t i = 0; i < layout.plane; ++i) plane[i] += spill[i];
      }
  }
}

template<class Real>
void SpringField<Real>::force(const Field<Real>& displacement, Field<Real>& force) const {
  for_each_slab(3, force.data(), [&](const Slab<Real>& slab) {
    kernels<Real>().force(springs_, slab, displacement.data(), force.data());
  });
  clear_constrained(body_, force);
}

template<class Real>
void SpringField<Real>::product(Clamp clamp, const Field<Real>& displacement, const Field<Real>& direction,
                                Field<Real>& product) const {
  for_each_slab(3, product.data(), [&](const Slab<Real>& slab) {
    kernels<Real>().product(springs_, slab, clamp, displacement.data(), direction.data(), product.data());
  });
  clear_constrained(body_, product);
}

template<class Real>
void SpringField<Real>::inverse_diagonal(Clamp clamp, const Field<Real>& displacement,
                                         Field<Real>& inverse) const {
  const Layout& layout = springs_.layout;
  inverse.setZero(6 * layout.size);
  for_each_slab(6, inverse.data(), [&](const Slab<Real>& slab) {
    kernels<Real>().diagonal(springs_, slab, clamp, displacement.data(), inverse.data());
  });
  std::vector<bool> is_constrained(index(3 * layout.size));
  for (const std::ptrdiff_t entry : body_.constrained) is_constrained[index(entry)] = true;
#pragma omp parallel for num_threads(n_threads_) schedule(static) if (n_threads_ > 1 && layout.size > piece)
  for (int k = 0; k < layout.nodes[2]; ++k)
    for (int j = 0; j < layout.nodes[1]; ++j)
      for (int i = 0; i < layout.nodes[0]; ++i) {
        Real* at = inverse.data() + layout.at(i, j, k);
        const auto entry = [&](int c) -> Real& { return at[c * layout.size]; };
        Eigen::Matrix3d block;
        block << entry(0), entry(5), entry(4), entry(5), entry(1), entry(3), entry(4), entry(3), entry(2);
        bool constrained[3];
        for (int a = 0; a < 3; ++a) {
          constrained[a] = is_constrained[index(a * layout.size + layout.at(i, j, k))] || !(block(a, a) > 0);
          if (!constrained[a]) continue;
          block.row(a).setZero();
          block.col(a).setZero();
          block(a, a) = 1;
        }
        Eigen::Matrix3d inverted = block.inverse();
        // A node that hangs on too few springs has a singular block: its diagonal must do.
        if (!(block.determinant() > 1e-9 * block.diagonal().prod()))
          inverted = block.diagonal().cwiseInverse().asDiagonal();
        for (int a = 0; a < 3; ++a)
          if (constrained[a]) inverted(a, a) = 0;
        entry(0) = static_cast<Real>(inverted(0, 0));
        entry(1) = static_cast<Real>(inverted(1, 1));
        entry(2) = static_cast<Real>(inverted(2, 2));
        entry(3) = static_cast<Real>(inverted(1, 2));
        entry(4) = static_cast<Real>(inverted(0, 2));
        entry(5) = static_cast<Real>(inverted(0, 1));
      }
}

template<class Real>
double SpringField<Real>::energy(const Field<Real>& displacement) const {
  const int n = n_slabs();
  Eigen::VectorXd part(n);
#pragma omp parallel for num_threads(n_threads_)                                                             \
    schedule(static) if (n_threads_ > 1 && springs_.layout.size > piece)
  for (int s = 0; s < n; ++s)
    part[s] = kernels<Real>().energy(springs_, first_plane(s, n, springs_.layout.nodes[2]),
                                     first_plane(s + 1, n, springs_.layout.nodes[2]), displacement.data());
  double sum = 0;
  for (double value : part) sum += value;
  return sum;
}

template class SpringField<double>;
template class SpringField<float>;

} // namespace springproof::msm::grid
