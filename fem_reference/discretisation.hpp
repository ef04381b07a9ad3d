#pragma once

#include "fem_reference/geometry.hpp"
#include "mechanics/contact/contact.hpp"

#include <memory>
#include <utility>

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
  /// Owned nodes with a pressure, and the integral of each one's shape function, mm³.
  std::vector<std::pair<int, double>> pressures;
  long n_pressures = 0;                          ///< all ranks'
  std::vector<mechanics::ToolSide> tool_sides{}; ///< the scene's tools and the nodes that they may touch

  /// Full load of a scene that differs from this one in its loads alone, N per owned degree of freedom.
  std::vector<double> load_of(const cases::Scene& scene) const;

  /// Unknowns of the linear systems: those of local node k are n_per_node*k + component, the fourth a
  /// pressure.
  int n_per_node() const { return element.n_unknowns_per_node(); }
  std::size_t unknown(std::size_t dof) const { return dof / 3 * cases::index(n_per_node()) + dof % 3; }
  std::size_t pressure_of(int node) const { return 4 * cases::index(node) + 3; }
  bool is_held(std::size_t unknown) const;

  /// A ghosted vector of the unknowns, zero.
  Vector make_vector() const { return nodes.make_vector(communicator, n_per_node()); }
  /// A zero matrix with the tangent's sparsity, which takes values at local unknowns. Rows and columns of
  /// those that are held have their diagonal alone.
  Matrix make_tangent_matrix() const;

 private:
  void find_pressures();
  void find_tool_sides(const cases::Scene& scene);
};

} // namespace springproof::fem_reference
