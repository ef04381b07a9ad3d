#pragma once

#include "cases/scene/scene.hpp"
#include "fem_reference/laws/formulation.hpp"
#include "fem_reference/rest_shape.hpp"
#include "mechanics/block_matrix.hpp"
#include "mechanics/real_time/euler.hpp"

#include <functional>
#include <vector>

/// Finite elements whose nodes are the vertices of a mesh, as forces between points.
namespace springproof::fem_reference {

using mechanics::Points;

/// The cells of a scene at rest; those of a grid have one shape.
class RestCells {
 public:
  /// @param scene  must outlive this
  explicit RestCells(const cases::Scene& scene);
  const RestShape& shape(std::size_t cell) const { return shapes_[shape_number(cell)]; }
  /// The number of a cell's shape, and how many there are.
  std::size_t shape_number(std::size_t cell) const { return shapes_.size() == 1 ? 0 : cell; }
  std::size_t n_shapes() const { return shapes_.size(); }
  const cases::Scene& scene() const { return scene_; }

 private:
  const cases::Scene& scene_;
  std::vector<RestShape> shapes_;
};

/// What a cell contributes: degree of freedom 3*vertex + component.
struct CellForces {
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 24> force; ///< on the points, N: minus the energy's gradient
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 24, 24>
      tangent; ///< minus the force's derivative, N/mm
};
using CellVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 24>;

/// The law of all cells: forces of a cell at its vertices' displacement (mm), and the tangent where wanted.
/// @return whether it has finite ones
using CellLaw =
    std::function<bool(std::size_t cell, const CellVector& displacement, Wanted wanted, CellForces& found)>;
/// One for each thread.
using MakeCellLaw = std::function<CellLaw()>;

/// The law of a formulation at the points of elements without a pressure.
/// @param cells  must outlive the laws
MakeCellLaw law_at_points(const RestCells& cells, const std::vector<Formulation>& formulations,
                          cases::Element element);

/// Linear elasticity in the axes of the rotation of a cell's mean deformation gradient F = R U:
///   f = -R K (R^T x - X),  the tangent taken as R K R^T.
/// Source: Mueller and Gross, Graphics Interface 2004, eq. 5 and 6.
/// @param element  whose stiffness K is
MakeCellLaw corotational_law(const RestCells& cells, cases::Element element);

/// The elements of a scene with a law.
class VertexElements {
 public:
  /// @param cells  must outlive this
  VertexElements(const RestCells& cells, const MakeCellLaw& make_law, int n_threads);
  VertexElements(const VertexElements&) = delete;
  VertexElements& operator=(const VertexElements&) = delete;

  /// Internal forces, N, the same to the bit on any number of threads; not finite where a cell has none.
  Points forces(const Points& displacement);
  /// The same and the tangent as functions that refer to this.
  mechanics::ForcesAt forces();
  mechanics::FreeTangent tangent();

 private:
  struct Place {
    std::size_t cell, vertex;
  };
  const RestCells& cells_;
  int n_threads_;
  std::vector<CellLaw> laws_;               ///< one for each thread
  std::vector<CellVector> force_;           ///< one for each cell
  std::vector<std::vector<Place>> at_node_; ///< each node's cells
  mechanics::BlockMatrix matrix_;

  CellVector in_cell(std::size_t cell, const Points& displacement) const;
  template<class Sink>
  void visit_blocks(const Points& displacement, const Sink& sink);
};

} // namespace springproof::fem_reference
