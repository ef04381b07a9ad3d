#pragma once

#include "mechanics/block_matrix.hpp"
#include "msm/lattice.hpp"

namespace springproof::msm {

/// Second derivative of energy() as 3x3 blocks: calls sink(row point, column point, block in N/mm) for every
/// contribution with row point >= column point (the matrix is symmetric). Clamped, the sum is positive
/// semidefinite.
template<class Sink>
void visit_tangent_blocks(const Lattice& lattice, const Points& positions, Clamp clamp, const Sink& sink) {
  for_each_kind(lattice, [&](const auto& terms) {
    for (const auto& of : terms) {
      const auto nodes = nodes_of(of);
      const auto block = of.tangent(at_nodes(nodes, positions), clamp);
      for (std::size_t a = 0; a < nodes.size(); ++a)
        for (std::size_t b = 0; b < nodes.size(); ++b)
          if (nodes[a] >= nodes[b]) sink(nodes[a], nodes[b], block(a, b));
    }
  });
}

/// The sparse tangent stiffness of a lattice on its free degrees of freedom.
class Tangent {
 public:
  using Matrix = mechanics::BlockMatrix::Matrix;

  /// @param lattice   must outlive the tangent
  /// @param is_constrained  degree of freedom 3*point + component, three entries per point
  Tangent(const Lattice& lattice, const std::vector<bool>& is_constrained);

  /// Lower triangle, N/mm, at these positions (mm).
  const Matrix& assemble(const Points& positions, Clamp clamp);

  int n_free() const { return matrix_.n_free(); }
  /// Number among the free ones of degree of freedom 3*point + component, or -1.
  const std::vector<int>& free_number() const { return matrix_.free_number(); }

 private:
  const Lattice& lattice_;
  mechanics::BlockMatrix matrix_;
};

} // namespace springproof::msm
