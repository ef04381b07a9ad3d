#pragma once

#include "fem_reference/geometry.hpp"

#include <functional>

namespace springproof::fem_reference {

/// What verification needs beyond a case: a body force and displacements that are not zero where the scene is
/// fixed.
struct Prescribed {
  std::function<Eigen::Vector3d(const Eigen::Vector3d& rest_point)> body_force; ///< N/mm³ at rest; none: zero
  std::function<Eigen::Vector3d(const Eigen::Vector3d& rest_point)>
      displacement; ///< mm, on constrained components; none: zero
};

/// The constrained degrees of freedom of a rank's nodes and the displacements prescribed there.
class Constraints {
 public:
  Constraints(const cases::Scene& scene, const Nodes& nodes, const Prescribed& prescribed,
              MPI_Comm communicator);

  std::vector<char> is_constrained; ///< per local degree of freedom
  long n_unknowns = 0;              ///< unconstrained degrees of freedom of all ranks
  bool are_moved = false;           ///< some of the constrained ones, of any rank

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
  std::vector<double> at_full_load_; ///< mm, proportional to the load factor; 0 where moved
  std::vector<MovedNode> moved_;

  template<class Factor>
  void prescribe_moved(const Factor& factor, std::vector<double>& displacement) const;
};

} // namespace springproof::fem_reference
