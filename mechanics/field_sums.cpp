#include "mechanics/field_sums.hpp"

#include "cases/case/error.hpp"
#include "cases/scene/loads.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <numeric>
#include <utility>

namespace springproof::mechanics {

namespace {

using Eigen::Matrix3d;

/// Returns the components of the symmetric part.
cases::SymmetricTensor in_order(const Matrix3d& m) {
  return {
      m(0, 0), m(1, 1), m(2, 2), (m(0, 1) + m(1, 0)) / 2, (m(1, 2) + m(2, 1)) / 2, (m(0, 2) + m(2, 0)) / 2};
}

/// Returns the forces on the nodes that are here, N.
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

constexpr double tolerance_at_nodes = 1e-6, ///< far above that of solvers, and far below a forgotten load
    tolerance_as_a_whole = 0.05;

/// Sum of the forces on nodes, and their norm.
struct Resultant {
  Eigen::Vector3d force = Eigen::Vector3d::Zero(); ///< N
  double norm = 0;                                 ///< N, all nodes' forces taken as one vector
};

/// @param forces  N, one per node that is here
Resultant resultant(const std::vector<Eigen::Vector3d>& forces, const cases::Share& here,
                    const cases::Sharing* sharing) {
  Resultant sum;
  for (std::size_t n = here.own_nodes.begin; n < here.own_nodes.end; ++n) {
    sum.force += forces[n - here.nodes.begin];
    sum.norm += forces[n - here.nodes.begin].squaredNorm();
  }
  if (sharing) {
    for (double& component : sum.force) component = sharing->sum(component);
    sum.norm = sharing->sum(sum.norm);
  }
  sum.norm = std::sqrt(sum.norm);
  return sum;
}

/// Subtracts the applied forces from the internal ones (N, on the nodes that are here). Returns the result on
/// constrained degrees of freedom, the reactions; on free ones it must vanish in equilibrium.
std::vector<Eigen::Vector3d> reactions(const cases::Scene& scene, std::vector<Eigen::Vector3d> force,
                                       const cases::Share& here, const cases::Sharing* sharing,
                                       const FieldsOf& of) {
  std::vector<Eigen::Vector3d> applied(force.size(), Eigen::Vector3d::Zero()), reaction = applied;
  for (const auto& [node, load] : cases::applied_forces(scene, of.shared))
    if (here.nodes.has(cases::index(node)))
      applied[cases::index(node) - here.nodes.begin] += of.load_factor * load;
  for (const cases::ToolContact& tool : of.tools)
    for (std::size_t n = 0; n < tool.nodes.size(); ++n)
      applied[cases::index(tool.nodes[n]) - here.nodes.begin] += tool.on_nodes[n];
  for (std::size_t n = 0; n < force.size(); ++n) force[n] -= applied[n];
  for (const auto& [selection, components] : scene.constrained)
    for (const int node : selection.nodes) {
      if (!here.nodes.has(cases::index(node))) continue;
      const std::size_t at = cases::index(node) - here.nodes.begin;
      for (Eigen::Index a = 0; a < 3; ++a)
        if (components[cases::index(static_cast<int>(a))] && force[at][a] != 0)
          reaction[at][a] = std::exchange(force[at][a], 0);
    }
  if (of.balance == Balance::not_asked) return reaction;
  const Resultant loads = resultant(applied, here, sharing), supports = resultant(reaction, here, sharing),
                  left = resultant(force, here, sharing);
  const bool is_balanced = of.balance == Balance::at_nodes
                               ? left.norm <= tolerance_at_nodes * std::max(loads.norm, supports.norm)
                               : (loads.force + supports.force).norm() <=
                                     tolerance_as_a_whole * std::max(loads.norm, supports.norm);
  if (!is_balanced)
    throw cases::SolveError(fmt::format(
        "the supports bear ({:.6g}, {:.6g}, {:.6g}) N, and ({:.6g}, {:.6g}, {:.6g}) N are applied: they do "
        "not balance, by {:.2g} N on the nodes; no answer to this case, and a defect to report",
        supports.force.x(), supports.force.y(), supports.force.z(), loads.force.x(), loads.force.y(),
        loads.force.z(), left.norm));
  return reaction;
}

} // namespace

/// Uses V² - I = H + H^T + H H^T, in which small strains keep their digits.
Matrix3d logarithmic_strain(const Matrix3d& h) {
  const Eigen::SelfAdjointEigenSolver<Matrix3d> left(h + h.transpose() + h * h.transpose());
  const auto half_log = [](double excess) {
    return std::log1p(std::max(excess, std::numeric_limits<double>::epsilon() - 1)) / 2;
  };
  const Eigen::Vector3d strain = left.eigenvalues().unaryExpr(half_log);
  return left.eigenvectors() * strain.asDiagonal() * left.eigenvectors().transpose();
}

cases::Fields fields_of(const cases::Scene& scene, FieldSums sums, const cases::Sharing* sharing,
                        const FieldsOf& of) {
  const cases::Share here = cases::share_here(scene.mesh, sharing);
  cases::Fields fields;
  fields.reaction = reactions(scene, forces_here(sums, sharing, scene.mesh.nodes.size()), here, sharing, of);
  for (CellSums& cell : cells_here(sums, sharing)) {
    const Matrix3d gradient = cell.gradient() / cell.rest_volume();
    fields.strain_energy.push_back(cell.energy());
    fields.stress.push_back(in_order(cell.virial() / cell.volume()));
    fields.strain.push_back(
        in_order(of.measure == StrainMeasure::linear ? gradient : logarithmic_strain(gradient)));
  }
  fields.total_energy = std::accumulate(fields.strain_energy.begin(), fields.strain_energy.end(), 0.0);
  if (sharing) fields.total_energy = sharing->sum(fields.total_energy);
  return fields;
}

} // namespace springproof::mechanics
