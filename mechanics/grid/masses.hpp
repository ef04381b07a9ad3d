#pragma once

namespace springproof::mechanics::grid {

/// Masses of trilinear cells on a grid, or any multiple of them: weights of two matrices of a cell, times its
/// mass. Consistent less lumped moves no rigid body.
template<class Real>
struct Masses {
  const Real* of_cell; ///< per cell, 16 entries more than there are; 0 where there is none
  Real consistent;     ///< weight of the integrals of N_a N_b over the volume, [2 1; 1 2]/6 along each axis
  Real lumped;         ///< weight of an eighth on the diagonal
};

} // namespace springproof::mechanics::grid
