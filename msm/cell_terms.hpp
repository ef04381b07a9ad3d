#pragma once

#include "cases/case/names.hpp"
#include "cases/mesh/sharing.hpp"
#include "msm/lattice.hpp"

#include <functional>

/// Cells that are more than four stiffnesses: springs between any two vertices, each with a law of its own,
/// tetrahedra of biquadratic springs, a volume term. Bodies of them are assembled; the grid's kernels know
/// cells of four stiffnesses (CellStiffness) alone.
namespace springproof::msm {

/// A spring between two vertices of a cell, at rest in the cell's rest shape.
struct CellSpring {
  std::array<int, 2> vertices;
  double stiffness; ///< N/mm
  SpringLaw law{};
};

/// A tetrahedron of a cell, of biquadratic springs.
struct CellTetrahedron {
  std::array<int, 4> vertices;
  double lambda, mu; ///< MPa
};

struct CellTerms {
  std::vector<CellSpring> springs{};
  std::vector<CellTetrahedron> tetrahedra{};
  double volume = 0;           ///< k_v, MPa
  bool is_logarithmic = false; ///< the volume term
};

/// Springs that cells share.
SPRINGPROOF_ENUMERATION(Boundary,
                        shared, ///< have the sum of their cells' stiffnesses: at the boundary, of fewer cells
                        whole   ///< have at the boundary what they have inside a grid
)

/// What the cells of a body consist of.
struct BodyTerms {
  std::vector<CellTerms> kinds;
  std::vector<int> kind_of_cell{}; ///< of every cell, an index of kinds; empty: all are of the first
  Boundary boundary = Boundary::shared;
  std::vector<int>
      planes_of_node{}; ///< bits of the planes of symmetry that a node is on; empty: there are none
};

/// The same springs and volume term, as terms.
CellTerms terms_of(const CellStiffness& stiffness);

/// Springs whose stiffnesses differ from axis to axis.
/// @param stiffness  N/mm: k_e along x, y, z; k_f in the faces across x, y, z; k_d    @param volume  k_v, MPa
CellTerms terms_by_axis(const std::array<double, 7>& stiffness, double volume);

/// All stiffnesses times a factor.
CellTerms scaled(CellTerms terms, double factor);

/// The kind of a cell's spring by the number of axes that it crosses: 1 an edge, 2 a face diagonal, 3 an
/// internal diagonal.
int n_axes(const CellSpring& spring);

/// Springs get the law and the exponent of their kind, the volume term the law beside theirs.
void set_exponents(CellTerms& terms, const Exponents& exponents);

/// Calls action(number, terms) for cells in ascending order, each spring with the cell's part of its link.
void for_each_cell(const cases::HexMesh& mesh, const BodyTerms& terms, const cases::Range& cells,
                   const std::function<void(std::size_t, const CellTerms&)>& action);

/// The lattice of a body of such cells. Springs and volume terms of stiffness 0 are left out.
Lattice make_lattice(const cases::HexMesh& mesh, const BodyTerms& terms);

} // namespace springproof::msm
