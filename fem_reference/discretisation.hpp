#pragma once

#include "fem_reference/geometry.hpp"

#include <memory>

namespace springproof::fem_reference {

/// The constrained degrees of freedom of a rank's nodes and the displacements prescribed there.
class Constraints {
 public:
  Constraints(const cases::Scene& scene, const Nodes& nodes, MPI_Comm communicator);

  std::vector<char> is_constrained; ///< per local degree of freedom
  /// Displacements at full load, mm, proportional to the load factor: 0 on all that a scene constrains and
  /// does not move.
  std::vector<double> at_full_load;
  long n_unknowns = 0;    ///< unconstrained degrees of freedom of all ranks
  bool are_moved = false; ///< some of the constrained ones, of any rank

  /// Displacements prescribed at a load factor, mm per local degree of freedom; 0 where unconstrained.
  void prescribe(double load_factor, std::vector<double>& displacement) const;
  /// The same at a time (s), by the histories of what is moved.
  void prescribe_at(double time, std::vector<double>& displacement) const;

 private:
  struct MovedNode {
    int node; ///< local
    Eigen::Vector3d rest;
    cases::Moved motion;
  };
  std::vector<MovedNode> moved_;

  template<class Factor>
  void prescribe_moved(const Factor& factor, std::vector<double>& displacement) const;
};

/// One rank's share of a scene in plain arrays, filled by deal.II.
class Discretisation {
  std::unique_ptr<Space> space_; // first: what follows is made from it

 public:
  /// @param scene  already refined: every node of its mesh keeps its number
  Discretisation(const cases::Scene& scene, const ElementType& element, MPI_Comm communicator);
  ~Discretisation();
  Discretisation(const Discretisation&) = delete; // its parts refer to each other
  Discretisation& operator=(const Discretisation&) = delete;

  MPI_Comm communicator;
  ElementType element;
  Nodes nodes;
  Geometry geometry;
  Constraints constraints;
  std::vector<double> load;          ///< the scene's, N per owned degree of freedom
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
