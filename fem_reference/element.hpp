#pragma once

#include "cases/case/case.hpp"
#include "cases/mesh/cell_shape.hpp"
#include "fem_reference/laws/point.hpp"

#include <vector>

namespace springproof::fem_reference {

/// How an element takes the pressure of a law.
///
/// One constant mode makes the cell's pressure p(v/V0), v and V0 its deformed and rest volume: the mean
/// dilatation or B-bar element. The pressure could be eliminated, but as an unknown of its own it follows
/// Newton's linear prediction, not the law's, whose slope is the bulk modulus: at bulk/shear 2000 that takes
/// 5 to 30 iterations where elimination was measured to take 40 to 240, to the same solution.
enum class Pressure {
  pointwise, ///< p(J) at every quadrature point
  modes,     ///< an unknown of its own per cell, balanced with the cell's volume and condensed in the linear
             ///< solve
  nodes      ///< continuous: unknowns of the vertices, in the linear solve beside the displacements
};

/// An element, as its cells' equations need it.
struct ElementType {
  cases::Element name;
  cases::CellShape shape;
  int degree; ///< the displacement's; of a hexahedron, per direction
  Pressure pressure;
  int n_pressure_modes; ///< 1: constant; 4: linear in the rest coordinates, or a tetrahedron's vertices'
  /// Displacements of its own that a cell adds, each with three components: 3 are Wilson's 1 - xi_a², a = 1,
  /// 2, 3, whose gradients are constant-free (Taylor, Beresford and Wilson, Int. J. Numer. Meth. Engng. 10,
  /// 1976), on any hexahedron.
  int n_bubbles = 0;

  int n_nodes() const;
  /// Points at which a cell's stress is evaluated. In tetrahedra they are as few as make its forces exact in
  /// small strains, 1 or 4.
  int n_points() const;
  /// Unknowns in a linear system for each node: its displacement, and a pressure, held where it has none.
  int n_unknowns_per_node() const { return pressure == Pressure::nodes ? 4 : 3; }
  /// Numbers of a cell's state beside the displacement: pressures, those of its vertices too, or the bubbles'
  /// components. But for those of vertices they are condensed in the linear solve.
  int n_internal() const { return n_pressure_modes + 3 * n_bubbles; }
};

/// @throws InputError when the law has no pressure of its own and the element needs one
ElementType element_type(const cases::Fem& fem, const LawTraits& law);

/// Rest geometry of one cell. Degree of freedom i*n_nodes + a is component i of node a.
struct CellGeometry {
  int n_nodes;
  int n_functions; ///< nodes, and bubbles after them
  int n_points;
  const double* gradients; ///< dN_a/dX_J at point q: [(3*q + J)*n_functions + a], 1/mm
  const double* weights;   ///< quadrature weight times Jacobian, mm³
  const double* modes;     ///< pressure shape functions: [q*n_pressure_modes + m]
};

using RowMajorMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// What a cell contributes, and what its condensed unknowns need afterwards: pressures (MPa) or the
/// components of bubbles (mm, 3*bubble + i). With pressures of nodes none are condensed: the forces have R
/// after them, and the tangent is the cell's part [K B^T; B -C] of the body's (CellKernel).
struct CellResult {
  bool valid;              ///< false: J <= 0 or not a number at a quadrature point; nothing else is set
  double volume_mismatch;  ///< largest |integral of mode (J - J(p))| / rest volume
  double bubble_imbalance; ///< squared, N²
  Eigen::VectorXd force;   ///< internal, N; has the condensed imbalance when a tangent is wanted
  RowMajorMatrix tangent;  ///< N/mm
  Eigen::VectorXd internal_residual; ///< change of the internal unknowns at fixed displacement
  RowMajorMatrix internal_slope;     ///< their change by displacement, (unknown, dof)
  Eigen::VectorXd plain_force;       ///< internal force without the condensed imbalance
};

/// What the memory of its material makes of a cell's second Piola-Kirchhoff stress S and pressure p at a
/// point, constants of a step: factor S + remembered. Both are in the material's axes, which do not turn with
/// the body. Numbers are [7*q + c]: S as xx, yy, zz, yz, xz, xy, and p, MPa.
struct CellMemory {
  static constexpr int n = 7, pressure = 6;              ///< numbers of a point, and p among them
  const double *factor = nullptr, *remembered = nullptr; ///< null: nothing is remembered
};

/// Loop over the points of a cell, its buffers kept between cells; LawKernel adds the law.
///
/// Internal force f = sum w (P + p cof F) . grad N. With pressure modes phi_m the cell also balances
/// R_m = sum w phi_m (J - J(p)), whose linearisation  R + B du - C dp = 0, C_mn = sum w phi_m phi_n J'(p), is
/// solved for dp, which leaves K + B^T C^-1 B and f + B^T C^-1 R for the displacement. Pressures of nodes are
/// in balance with the volumes of all cells around, so they stay.
///
/// Bubbles b are displacements that the cell alone has: their forces f_b vanish. Newton's method solves
/// f_b + K_bu du + K_bb db = 0 for db, which leaves K - K_ub K_bb^-1 K_bu and f - K_ub K_bb^-1 f_b.
class CellKernel {
 public:
  explicit CellKernel(const ElementType& element);
  virtual ~CellKernel() = default;

  /// @param displacement  mm, [3*a + i]
  /// @param internal      the element's n_internal() unknowns; ignored without any
  /// @return valid until the next call
  const CellResult& evaluate(const CellGeometry& geometry, const double* displacement, const double* internal,
                             Wanted wanted, const CellMemory& memory = {});
  /// Writes what a memory is of: the elastic S and p of the cell's points. The pressure of a constant mode is
  /// that of the cell's mean dilatation.  @param elastic  [7*q + c], as in CellMemory
  void elastic(const CellGeometry& geometry, const double* displacement, const double* internal,
               double* elastic) {
    elastic_of(geometry, with_bubbles(geometry, displacement, internal), elastic);
  }
  /// Strain energy of the cell in a state that evaluate() finds valid, N mm. With pressure modes the volume
  /// ratios follow from the pressures.
  double energy(const CellGeometry& geometry, const double* displacement, const double* internal) {
    return energy_of(geometry, with_bubbles(geometry, displacement, internal), internal);
  }
  /// Volume of the cell with its nodes displaced, mm³, whatever the kinematics of its law.
  static double deformed_volume(const CellGeometry& geometry, const double* displacement);

 protected:
  virtual double energy_of(const CellGeometry& geometry, const double* displacement,
                           const double* pressure) const = 0;
  /// Calls add_point() for every point.  @return false at one that is inverted or not a number
  virtual bool add_points(const CellGeometry& geometry, const double* displacement, const double* pressure,
                          Wanted wanted) = 0;
  virtual void elastic_of(const CellGeometry& geometry, const double* displacement, double* elastic) = 0;
  /// Adds a point's memory to its stress_, which is without the pressure.
  void remember(Kinematics kinematics, const Matrix3& f, int point, Wanted wanted);
  /// @param displacement  of the first n_functions functions, mm
  static Matrix3 displacement_gradient(const CellGeometry& geometry, int point, const double* displacement,
                                       int n_functions);
  /// Adds the point's stress_ to the force, and when wanted sets its w A grad N for the tangent.
  void add_point(const CellGeometry& geometry, int point, Wanted wanted);

  ElementType element_;
  CellMemory memory_;
  PointStress stress_;             ///< at the point, with its pressure
  std::vector<double> dilatation_; ///< J - 1
  std::vector<Matrix3, Eigen::aligned_allocator<Matrix3>> cofactor_;
  std::vector<ValueAndSlope> target_; ///< with modes: J(p) - 1 and its slope

 private:
  void volume_gradients(const CellGeometry& geometry);
  void balance_volumes(const CellGeometry& geometry);
  void append_pressures(const CellGeometry& geometry, Wanted wanted);
  void add_stiffness(const CellGeometry& geometry);
  void condense(const CellGeometry& geometry, Wanted wanted);
  void condense_bubbles(const CellGeometry& geometry, Wanted wanted);
  /// Displacement of all functions, mm: the nodes', or these and the bubbles' in a buffer.
  const double* with_bubbles(const CellGeometry& geometry, const double* displacement,
                             const double* internal);

  CellResult result_;
  Eigen::VectorXd force_;            ///< on all functions
  RowMajorMatrix stiffness_;         ///< between all functions
  std::vector<double> displacement_; ///< one for each function and component
  RowMajorMatrix volume_gradient_;   ///< (mode, dof): B
  Eigen::VectorXd volume_residual_;  ///< R
  Eigen::MatrixXd compliance_;       ///< C
  std::vector<double> right_factor_; ///< w A grad N: [((i*n_points + q)*3 + J)*n_dofs + dof]
};

} // namespace springproof::fem_reference
