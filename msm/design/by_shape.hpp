#pragma once

#include "cases/mesh/mesh.hpp"
#include "mechanics/elastic_moduli.hpp"
#include "msm/spring_body.hpp"

#include <map>
#include <optional>

/// Springs for cells of any shape, by least squares over a mesh. Derived in
/// docs/developing/springs-on-any-mesh.md.
namespace springproof::msm {

/// The springs between a cell's vertices: a tetrahedron's six edges; a hexahedron's 12 edges, 12 face
/// diagonals and 4 internal diagonals.
const std::vector<std::array<int, 2>>& springs_of(cases::CellShape shape);

struct CellFit {
  std::vector<double> stiffness; ///< one per spring of springs_of(), N/mm
  double misfit;                 ///< root mean square over strains
};

/// The stiffnesses k >= 0 of a cell's own springs whose energies of strains, |S (C_k - C) S|² with the C and
/// S below, are nearest to the material's. Those of hybrid_method() in a cube, which fit exactly.
CellFit fit_cell(const cases::CellCorners& corners, const mechanics::ElasticModuli& moduli, double split);

/// What springs are fitted to.
struct FitRequest {
  std::vector<mechanics::ElasticModuli> moduli; ///< one per cell, mu > 0
  double split;                                 ///< t of hybrid_method()
  std::map<int, int> axes_of_node{};            ///< nodes on planes of symmetry, bits of the axes across them
};

struct ShapeFit {
  std::vector<CellTerms> cells; ///< one per cell
  /// Distance of the springs' energies of strains from the material's, as a part of it: root mean square over
  /// strains. Of cells alone, before their neighbours count.
  double median_misfit, worst_misfit;
  /// The same over nodes with what their neighbours add up to, and with the forces that uniform strains leave
  /// on nodes: of the fit of single cells, and of the fit over the mesh.
  double cell_by_cell, over_the_mesh;
  int n_loose_nodes; ///< whose springs hold them in fewer than three directions
};

/// The stiffnesses k >= 0 of least
///   sum over nodes  V |S (C_k - C) S|² + |f_k - f|² / D,
/// with  sum over nodes  V S (C_k - C) S = 0  in hexahedra whose springs can. C_k is the elasticity that the
/// halves of all springs at the node add, C that of Cauchy's solid with the material's mu (C12 = C44 = mu),
/// f_k and f the forces on the node under the six strains S that the material stores equal energies for, D
/// the mean of the node's springs over the directions, V its share of the cells' volume. Found by coordinate
/// descent from k l² = V mu times the share of the kind of spring, with which cubes have the hybrid lattice.
/// The volume terms are what the springs lack of the bulk modulus in the mean over the mesh, k_v = K - 5/3 mu
/// (sum k l²)/(15 sum mu V), of tetrahedra at their nodes.
ShapeFit fit_by_shape(const cases::Mesh& mesh, const FitRequest& request);

/// Springs of one stiffness in a mesh of tetrahedra, of the mean E along its axes: sum k l² = 6 E V, as Van
/// Gelder's.  @param youngs_modulus  E of each cell, MPa    @param stiffness  another stiffness of all, N/mm
std::vector<CellTerms> uniform_by_shape(const cases::Mesh& mesh, const std::vector<double>& youngs_modulus,
                                        std::optional<double> stiffness = std::nullopt);

} // namespace springproof::msm
