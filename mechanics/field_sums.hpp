#pragma once

#include "cases/case/solution.hpp"
#include "cases/mesh/sharing.hpp"
#include "cases/scene/scene.hpp"

#include <utility>

/// Stress, strain, energy and reactions, made alike for both models from the forces that elements or springs
/// exert on their nodes.
///
/// The mean Cauchy stress over a deformed cell is its virial over its volume,
///   sigma = 1/v sum_a f_a (x) x_a,
/// f_a the internal force of the cell's own elements or springs on node a, at x_a. For elements, whose shape
/// functions reproduce linear fields, it is the exact mean of the stress at their quadrature points, since
/// sum_a x_a (x) grad N_a = F. For springs it is sum T d (x) d/|d| over the cell's springs and the volume
/// term's pressure, since sum_a x_a (x) dV/dx_a = V I: the static virial stress. Source: D. H. Tsai, The
/// virial theorem and stress calculation in molecular dynamics, J. Chem. Phys. 70 (1979); R. Hill, Elastic
/// properties of reinforced solids, J. Mech. Phys. Solids 11 (1963), for the mean from boundary data.
namespace springproof::mechanics {

/// Numbers alone, so that ranks can add them up.
struct CellSums {
  std::array<double, 21> numbers{};
  /// Sum of f_a (x) x_a, N mm.
  Eigen::Map<Eigen::Matrix3d> virial() { return Eigen::Map<Eigen::Matrix3d>(numbers.data()); }
  /// Integral of the displacement gradient, mm³.
  Eigen::Map<Eigen::Matrix3d> gradient() { return Eigen::Map<Eigen::Matrix3d>(numbers.data() + 9); }
  double& rest_volume() { return numbers[18]; } ///< mm³; 0: nothing was added
  double& volume() { return numbers[19]; }      ///< deformed, mm³; the virial refers to it
  double& energy() { return numbers[20]; }      ///< N mm
};

/// Sums of a model, or of a rank of it, on the body's own mesh, for a range of nodes and one of cells.
class FieldSums {
 public:
  FieldSums(const cases::Range& nodes, const cases::Range& cells)
      : nodes_(nodes), cells_(cells), forces_(nodes.size(), Eigen::Vector3d::Zero()),
        sums_of_cells_(cells.size()) {}

  /// Gradient of the energy, N.
  Eigen::Vector3d& force(std::size_t node) { return forces_[node - nodes_.begin]; }
  CellSums& cell(std::size_t number) { return sums_of_cells_[number - cells_.begin]; }

  /// Takes out the sums of all cells, and leaves none.
  std::vector<CellSums> take_cells() { return std::exchange(sums_of_cells_, {}); }

  const cases::Range& nodes() const { return nodes_; }
  const cases::Range& cells() const { return cells_; }

 private:
  cases::Range nodes_, cells_;
  std::vector<Eigen::Vector3d> forces_;
  std::vector<CellSums> sums_of_cells_;
};

/// Linear: small_strain, whose stress and strain do not tell the deformed body from the one at rest.
enum class StrainMeasure { logarithmic, linear };

/// How reactions have to balance the loads of the scene.
enum class Balance {
  not_asked,  ///< an answer after a given number of iterations, or a state without loads
  as_a_whole, ///< the model's share of a load differs from node to node from the scene's: forces as sums, to
              ///< 5 %
  at_nodes    ///< every node of the body's own mesh, to 1e-6: so forces and moments do
};

/// What fields refer to.
struct FieldsOf {
  double load_factor; ///< factor on the scene's loads
  StrainMeasure measure;
  cases::PointMass shared; ///< how the model's nodes share the mass that gravity acts on
  Balance balance;
  std::vector<cases::ToolContact> tools{}; ///< what they do to the body, with forces that are not scaled
};

/// The fields of a solution, each rank's share of them. Reactions are internal forces less the applied ones,
/// on constrained degrees of freedom. On the others an equilibrium leaves nothing: internal forces are held
/// against the loads of the scene, which the solver had from elsewhere. Collective.
/// @param sums     what this rank adds; all cells where nobody shares the answer
/// @param sharing  the ranks that share the solution; null: one rank has all of it
/// @throws SolveError where an equilibrium's reactions do not balance the loads
cases::Fields fields_of(const cases::Scene& scene, FieldSums sums, const cases::Sharing* sharing,
                        const FieldsOf& of);

/// ln V of a displacement gradient H, F = I + H, V² = F F^T. Finite for every finite H: where F is singular
/// its stretch counts as 1.5e-8.
Eigen::Matrix3d logarithmic_strain(const Eigen::Matrix3d& displacement_gradient);

} // namespace springproof::mechanics
