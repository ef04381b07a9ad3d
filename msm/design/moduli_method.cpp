#include "msm/design/moduli_method.hpp"

#include <cmath>

namespace msm {

namespace {

/// A cell's share of the assembled stiffnesses: an edge belongs to four cells, a face diagonal to two.
CellStiffness cell_share(double edges, double face_diagonals, double internal_diagonals, double volume) {
  return {edges / 4, face_diagonals / 2, internal_diagonals, volume};
}

} // namespace

CellStiffness moduli_method(double youngs_modulus, double shear_modulus, double split, double edge) {
  const double difference = youngs_modulus - shear_modulus;
  const double sum = youngs_modulus + shear_modulus;
  const double c11 = (difference + std::sqrt(sum * sum + 8 * shear_modulus * shear_modulus)) / 2;
  const double internal_diagonals = 0.75 * split * shear_modulus * edge;
  const double face_diagonals = (1 - split) * shear_modulus * edge;
  return cell_share(c11 * edge - 2 * face_diagonals - 4 * internal_diagonals / 3, face_diagonals,
                    internal_diagonals, 0);
}

CellStiffness hybrid_method(double lame_lambda, double lame_mu, double split, double edge) {
  const double internal_diagonals = 0.75 * split * lame_mu * edge;
  const double face_diagonals = (1 - split) * lame_mu * edge;
  return cell_share(face_diagonals + 8 * internal_diagonals / 3, face_diagonals, internal_diagonals,
                    lame_lambda - lame_mu);
}

} // namespace msm
