#pragma once

#include "fem_reference/constraints.hpp"
#include "fem_reference/geometry.hpp"

#include <memory>

namespace springproof::fem_reference {

/// One rank's share of a scene in plain arrays, filled by deal.II.
class Discretisation {
  std::unique_ptr<Space> space_; // first: what follows is made from it

 public:
  /// @param scene  already refined: every node of its mesh keeps its number
  Discretisation(const cases::Scene& scene, const ElementType& element, const Prescribed& prescribed,
                 MPI_Comm communicator);
  ~Discretisation();
  Discretisation(const Discretisation&) = delete; // its parts refer to each other
  Discretisation& operator=(const Discretisation&) = delete;

  MPI_Comm communicator;
  ElementType element;
  Nodes nodes;
  Geometry geometry;
  Constraints constraints;
  std::vector<double> load;          ///< N per owned degree of freedom: the scene's loads and the body force
  std::vector<int> material_of_cell; ///< in the scene's materials; empty when there is but one

  /// Full load of a scene that differs from this one in its loads alone, N per owned degree of freedom.
  std::vector<double> load_of(const cases::Scene& scene) const;

  /// A ghosted vector of displacements or forces, zero.
  Vector make_vector() const { return nodes.make_vector(communicator); }
  /// A zero matrix with the tangent's sparsity, which takes values at local degrees of freedom. Rows and
  /// columns of constrained degrees of freedom have their diagonal alone.
  Matrix make_tangent_matrix() const;
};

} // namespace springproof::fem_reference
