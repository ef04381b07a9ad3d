#include "mechanics/field_sums.hpp"

#include "cases/scene/masses.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace springproof::mechanics {

namespace {

using Eigen::Matrix3d;

/// Of the symmetric part.
cases::SymmetricTensor in_order(const Matrix3d& m) {
  return {
      m(0, 0), m(1, 1), m(2, 2), (m(0, 1) + m(1, 0)) / 2, (m(1, 2) + m(2, 1)) / 2, (m(0, 2) + m(2, 0)) / 2};
}

/// Of the nodes that are here, N.
std::vector<Eigen::Vector3d> forces_here(FieldSums& sums, const cases::Sharing* sharing,
                                         std::size_t n_nodes) {
  std::vector<cases::Numbered<Eigen::Vector3d>> added;
  for (std::size_t node = sums.nodes().begin; node < sums.nodes().end; ++node)
    if (!sums.force(node).isZero(0)) added.push_back({static_cast<std::int64_t>(node), sums.force(node)});
  if (sharing) return sharing->add_up(std::move(added));
  return cases::deal<Eigen::Vector3d>(nullptr, std::move(added), n_nodes, Eigen::Vector3d::Zero());
}

std::vector<CellSums> cells_here(FieldSums& sums, const cases::Sharing* sharing) {
  std::vector<CellSums> here = sums.take_cells();
  if (!sharing) return here;
  std::vector<cases::Numbered<std::array<double, 21>>> added;
  for (std::size_t c = 0; c < here.size(); ++c)
    if (here[c].rest_volume() != 0)
      added.push_back({static_cast<std::int64_t>(sums.cells().begin + c), here[c].numbers});
  here = {};
  for (const auto& numbers : cases::deal(*sharing, added)) here.push_back({numbers});
  return here;
}

/// @param force  of the nodes that are here, N
std::vector<Eigen::Vector3d> reactions(const cases::Scene& scene, std::vector<Eigen::Vector3d> force,
                                       const cases::Range& here, double load_factor,
                                       cases::PointMass shared) {
  for (const auto& [node, load] : cases::applied_forces(scene, shared))
    if (here.has(cases::index(node))) force[cases::index(node) - here.begin] -= load_factor * load;
  std::vector<Eigen::Vector3d> reaction(force.size(), Eigen::Vector3d::Zero());
  for (const auto& [selection, components] : scene.constrained)
    for (const int node : selection.nodes) {
      if (!here.has(cases::index(node))) continue;
      const std::size_t at = cases::index(node) - here.begin;
      for (std::size_t a = 0; a < 3; ++a)
        if (components[a]) reaction[at][Eigen::Index(a)] = force[at][Eigen::Index(a)];
    }
  return reaction;
}

} // namespace

/// By V² - I = H + H^T + H H^T, in which small strains keep their digits.
Matrix3d logarithmic_strain(const Matrix3d& h) {
  const Eigen::SelfAdjointEigenSolver<Matrix3d> left(h + h.transpose() + h * h.transpose());
  const auto half_log = [](double excess) {
    return std::log1p(std::max(excess, std::numeric_limits<double>::epsilon() - 1)) / 2;
  };
  const Eigen::Vector3d strain = left.eigenvalues().unaryExpr(half_log);
  return left.eigenvectors() * strain.asDiagonal() * left.eigenvectors().transpose();
}

cases::Fields fields_of(const cases::Scene& scene, FieldSums sums, const cases::Sharing* sharing,
                        double load_factor, StrainMeasure measure, cases::PointMass shared) {
  const cases::Share here = cases::share_here(scene.mesh, sharing);
  cases::Fields fields;
  fields.reaction =
      reactions(scene, forces_here(sums, sharing, scene.mesh.nodes.size()), here.nodes, load_factor, shared);
  for (CellSums& cell : cells_here(sums, sharing)) {
    const Matrix3d gradient = cell.gradient() / cell.rest_volume();
    fields.strain_energy.push_back(cell.energy());
    fields.stress.push_back(in_order(cell.virial() / cell.volume()));
    fields.strain.push_back(
        in_order(measure == StrainMeasure::linear ? gradient : logarithmic_strain(gradient)));
  }
  fields.total_energy = std::accumulate(fields.strain_energy.begin(), fields.strain_energy.end(), 0.0);
  if (sharing) fields.total_energy = sharing->sum(fields.total_energy);
  return fields;
}

} // namespace springproof::mechanics
