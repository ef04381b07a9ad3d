#pragma once

#include "msm/grid/body.hpp"

#include <deque>

namespace springproof::msm::grid {

/// A body's springs as the kernels read them, and the kernels run over all of the body on a given number of
/// threads. The results do not depend on that number. On a part of a body every function is collective, takes
/// fields with their owners' values on ghosts, and gives such.
template<class Real>
class SpringField {
 public:
  SpringField(const Body& body, int n_threads);
  SpringField(SpringField&&) = default;

  /// Internal force, N, at a displacement (mm); 0 on constrained entries.
  void force(const Field<Real>& displacement, Field<Real>& force) const;
  /// The same with the forces on constrained entries.
  void reactions(const Field<Real>& displacement, Field<Real>& force) const;
  /// Tangent (N/mm) at a displacement times a direction; 0 on constrained entries.
  void product(Clamp clamp, const Field<Real>& displacement, const Field<Real>& direction,
               Field<Real>& product) const;
  /// The same for the clamped tangent that inverse_diagonal() has kept, at the same displacement.
  void kept_product(const Field<Real>& displacement, const Field<Real>& direction,
                    Field<Real>& product) const;
  /// Makes inverse_diagonal() keep the tangent from now on: 26 numbers for every node, and 7 for every cell
  /// with a volume term, which kept_product() reads in place of evaluating the law. Not done where that is no
  /// faster: for Hooke's law, and for bodies whose numbers do not stay in a cache.
  /// @return whether it is done
  bool keep_tangent();
  /// Inverses of the tangent's diagonal 3x3 blocks on the entries that are not constrained: six arrays, xx,
  /// yy, zz, yz, xz, xy.
  /// @param added  added to the tangent's diagonal; empty: nothing
  void inverse_diagonal(Clamp clamp, const Field<Real>& displacement, Field<Real>& inverse,
                        const Field<Real>& added = {}) const;
  double energy(const Field<Real>& displacement) const;
  /// What a small motion (mm) from rest stores to second order, as msm::small_motion_energy(), N mm.
  double small_motion_energy(const Field<Real>& motion) const;

 private:
  const Body& body_;
  int n_threads_;
  Springs<Real> springs_;
  std::vector<Slab<Real>> slabs_;
  std::deque<Field<Real>> arrays_; ///< what springs_ and slabs_ point to
  Real* kept_ = nullptr; ///< room for a tangent, in arrays_, on the boundary of a cache line; null: none
  std::vector<unsigned char> pack_use_;
  std::vector<int> block_of_pack_;
  std::vector<bool> is_constrained_; ///< every entry of a field
  std::vector<std::ptrdiff_t> held_; ///< constrained entries that have a cell
  mutable std::vector<double> energy_of_slab_;

  void set_shares();
  void set_by_node();
  Real* add_array(std::ptrdiff_t n);
  void pack_stiffness();
  void clear_held(Field<Real>& field) const;
  /// Calls action(0), ..., action(n - 1).
  template<class Action>
  void on_threads(std::ptrdiff_t n, const Action& action) const;
  template<class Run>
  void for_each_slab(int components, Real* result, const Run& run) const;
};

} // namespace springproof::msm::grid
