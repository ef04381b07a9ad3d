#pragma once

#include "mechanics/grid/smoother.hpp"
#include "msm/grid/cell_tangent.hpp"
#include "msm/grid/merged_cells.hpp"

#include <Eigen/Cholesky>
#include <deque>

namespace springproof::msm::grid {

/// The levels below the finest one of a body with gaps: coarse cells that hang together as the fine ones do
/// (MergedCells), with Galerkin's stiffness P^T K P of the clamped tangent, gathered cell by cell, as sparse
/// matrices of 3x3 blocks. Rediscretised coarse lattices (coarsen()) join what a narrow gap parts, and their
/// cells at a boundary are wrong by as much as they are empty: a head at 1.6 mm takes two to four times the
/// iterations of conjugate gradients with them.
class MergedMultigrid {
 public:
  /// @param finest  must outlive it; is no part of a body
  MergedMultigrid(const Body& finest, const mechanics::grid::Chebyshev& smoother, int n_threads);

  /// At a displacement of the finest body, mm.
  /// @param added  to the tangent's diagonal; of no size: nothing
  void linearise(const Field<float>& displacement, const Field<float>& added = {});

  /// correction = P cycle(P^T residual), both of the finest body; 0 on constrained entries.
  void correct(const Field<float>& residual, Field<float>& correction);

 private:
  using Nodes = Eigen::Matrix<float, 4, Eigen::Dynamic>; ///< a vector at every node, and 0
  using Block = std::array<Eigen::Vector4f, 3>;          ///< columns of a 3x3 matrix, each with a 0
  struct Level {
    MergedCells merged;
    Weights restriction; ///< transpose of the interpolation
    std::vector<CellMatrix> stiffness;
    std::vector<int> row, column; ///< of the matrix' blocks
    std::vector<Block> matrix;
    std::vector<std::array<int, 64>> blocks_of_cell;
    std::vector<Block> inverse_diagonal;
    Nodes solution, residual, correction, product, rough;
    double largest_eigenvalue = 0;
  };

  const Body& finest_;
  CellTangent cell_tangent_; ///< of the finest body
  mechanics::grid::Chebyshev smoother_;
  int n_threads_;
  Cells cells_;                              ///< of the finest body, without those that are held as a whole
  std::vector<std::ptrdiff_t> entry_;        ///< of every node, along x
  std::vector<std::array<bool, 3>> is_held_; ///< every node's components
  std::vector<int> n_cells_;                 ///< of every node
  std::deque<Level> levels_;
  std::vector<Eigen::Index> coarsest_unknowns_;
  Eigen::LLT<Eigen::MatrixXf> coarsest_;
  Eigen::MatrixXf coarsest_matrix_;
  Eigen::VectorXf coarsest_answer_;
  std::vector<Eigen::Index> coarsest_number_; ///< of every component of every node; -1: it does not move

  bool ends_exactly() const;
  void prepare(Level& level) const;
  CellMatrix stiffness_of(std::size_t cell, const Field<float>& displacement) const;
  void add_diagonal(std::size_t cell, const Field<float>& added, CellMatrix& to) const;
  template<class OfFiner>
  void gather_stiffness(Level& level, const OfFiner& of_finer, bool is_finest);
  void assemble(Level& level) const;
  void invert_diagonal(Level& level) const;
  void estimate_largest_eigenvalue(Level& level) const;
  void factorise_coarsest();
  void multiply(const Level& level, const Nodes& direction, Nodes& product) const;
  void smooth(Level& level, bool keeps_residual) const;
  void add_correction(Level& level, bool keeps_residual) const;
  void cycle(std::size_t l);
};

} // namespace springproof::msm::grid
