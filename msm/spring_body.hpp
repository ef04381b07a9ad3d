#pragma once

#include "cases/case/names.hpp"
#include "cases/mesh/sharing.hpp"
#include "cases/scene/scene.hpp"
#include "msm/lattice.hpp"

#include <functional>
#include <variant>

/// The springs of a body: of cells of four stiffnesses, of cells of more terms, or of no cells.
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

/// A spring between the centres of a cell's two faces across an axis.
struct CellMidline {
  int axis;
  double stiffness; ///< N/mm
  SpringLaw law{};
};

/// A cell of springs between any two vertices and of midlines, each with a law of its own, tetrahedra of
/// biquadratic springs, and a volume term.
struct CellTerms {
  std::vector<CellSpring> springs{};
  std::vector<CellTetrahedron> tetrahedra{};
  std::vector<CellMidline> midlines{};
  double volume = 0;           ///< k_v, MPa
  bool is_logarithmic = false; ///< the volume term
  bool is_at_nodes = false;    ///< the volume term, as a tetrahedron's must be: VolumePatch, not VolumeCell
};

/// Springs that cells share.
SPRINGPROOF_ENUMERATION(Boundary,
                        shared, ///< have the sum of their cells' stiffnesses: at the boundary, of fewer cells
                        whole   ///< have at the boundary what they have inside a grid
)

/// What the cells of a body consist of.
struct BodyTerms {
  std::vector<CellTerms> kinds;
  std::vector<int> kind_of_cell{}; ///< index of kinds, one per cell; empty: all are of the first
  Boundary boundary = Boundary::shared;
  std::vector<int>
      planes_of_node{}; ///< bits of the planes of symmetry that a node is on; empty: there are none
};

/// Springs of no cells, each a link of its own. Where a spring's rest length is not the distance of its
/// nodes, the body is under tension at rest.
using Network = std::vector<cases::NetworkSpring>;

/// The springs of a body, of one kind. Every use is a visit of the kinds: one that forgets a kind does not
/// compile.
struct SpringBody {
  /// Stiffnesses: one for every cell, or a single one for all; none: a body without springs. The grid solvers
  /// take such cells alone, the others are assembled.
  std::variant<std::vector<CellStiffness>, BodyTerms, Network> kind;

  SpringBody(std::initializer_list<CellStiffness> cells = {}) : kind(std::vector(cells)) {}
  SpringBody(std::vector<CellStiffness> cells) : kind(std::move(cells)) {}
  SpringBody(BodyTerms terms) : kind(std::move(terms)) {}
  SpringBody(Network springs) : kind(std::move(springs)) {}

  /// The springs as that kind, or null.
  const std::vector<CellStiffness>* cells() const { return std::get_if<std::vector<CellStiffness>>(&kind); }
  const BodyTerms* terms() const { return std::get_if<BodyTerms>(&kind); }
  const Network* network() const { return std::get_if<Network>(&kind); }
};

/// The same springs and volume term, as terms.
CellTerms terms_of(const CellStiffness& stiffness);

/// Stiffnesses of one cell by axis.
struct AxisStiffness {
  std::array<double, 7> springs; ///< N/mm: k_e along x, y, z; k_f in the faces across x, y, z; k_d
  double volume;                 ///< k_v, MPa
};
CellTerms terms_by_axis(const AxisStiffness& stiffness);

/// All stiffnesses times a factor.
CellTerms scaled(CellTerms terms, double factor);
/// All stiffnesses of every cell times its factor; those of a network times the first cell's.
SpringBody scaled(const SpringBody& springs, std::size_t n_cells,
                  const std::function<double(std::size_t cell)>& factor);

/// The kind of a cell's spring by the number of axes that it crosses: 1 an edge, 2 a face diagonal, 3 an
/// internal diagonal.
int n_axes(const CellSpring& spring);

/// Springs get the law and the exponent of their kind, the volume term the law beside theirs.
void set_exponents(CellTerms& terms, const Exponents& exponents);

/// Calls action(number, terms) for cells in ascending order, each spring with the cell's part of its link. A
/// network has no cells.
void for_each_cell(const cases::Mesh& mesh, const SpringBody& springs, const cases::Range& cells,
                   const std::function<void(std::size_t, const CellTerms&)>& action);

/// The lattice of a body: a shared edge or diagonal gets the sum of its cells' stiffnesses (thesis section
/// 4.3.1: an interior edge of a cubical lattice 4 k_e, an interior face diagonal 2 k_f). Springs and volume
/// terms of stiffness 0 are left out.
Lattice make_lattice(const cases::Mesh& mesh, const SpringBody& springs);

/// Whether a body has cells whose volume terms are at their nodes.
bool has_volume_patches(const SpringBody& springs);

/// The lattice of one cell, whose points are its corners; its springs are in their order among the terms.
Lattice cell_lattice(const CellTerms& terms, const cases::CellCorners& corners);

} // namespace springproof::msm
