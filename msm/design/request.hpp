#pragma once

#include "mechanics/elastic_moduli.hpp"
#include "msm/design/cells.hpp"
#include "msm/design/uniaxial.hpp"

#include <functional>
#include <optional>

/// What a design is made from, and what its methods read from it.
namespace springproof::msm {

/// Input of a design method.
struct DesignRequest {
  cases::Material material;
  CellVertices cell = cube(1); ///< mm
  cases::Msm options;          ///< the method and its settings, as in a case file's [msm]
  /// K_FEM of the cell for a small-strain material, N/mm; only the linear method asks for it.
  std::function<CellMatrix(const cases::LinearElastic&)> element_stiffness;
  std::optional<UniaxialCurve> uniaxial_reference; ///< measured or given curve instead of the material's own
  /// Number of cells from which on designs see no difference.
  static constexpr int many_cells = 8;
  int cells_across = many_cells; ///< the body's, where the cell is: cases::cells_across()
};

/// @throws InputError at the case's [msm]
[[noreturn]] void refuse(const DesignRequest& request, const std::string& problem);

template<class Value>
Value by_material(const DesignRequest& request, const Value& hyperelastic, const Value& linear_elastic) {
  return cases::is_hyperelastic(request.material) ? hyperelastic : linear_elastic;
}

/// The small-strain material that the design is made for: options.poissons_ratio replaces the material's own,
/// E stays.
/// @throws InputError unless E > 0 and nu lies in [lowest, 0.5)
cases::LinearElastic designed_material(const DesignRequest& request, double lowest_poissons_ratio);

/// Whether the material is hyperelastic without a bulk modulus and the case names no Poisson's ratio.
bool is_incompressible(const DesignRequest& request);

/// Moduli of designed_material(), or of a nearly incompressible stand-in where is_incompressible().
mechanics::ElasticModuli elastic_moduli(const DesignRequest& request);

/// Edge of the request's cell, mm.  @throws InputError when it is not a cube
double required_cube_edge(const DesignRequest& request);

LawKind law_kind(const DesignRequest& request);

/// Whether the design finds the exponents of power-log springs.
bool finds_exponents(const DesignRequest& request);

/// The law that a case gives its springs; nothing: Hooke's, or the design finds the exponents.
std::optional<Exponents> law_of(const DesignRequest& request);

/// t, the share of the shear stiffness that the internal diagonals carry.  @throws InputError outside [0, 1]
double split(const DesignRequest& request);

} // namespace springproof::msm
