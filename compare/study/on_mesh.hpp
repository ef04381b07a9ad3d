#pragma once

#include "cases/scene/scene.hpp"
#include "msm/design/cells.hpp"

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

/// What the springs of designs can do on a case's own mesh, before anything is solved.
namespace springproof::compare {

/// The cells of one material.
struct MaterialOnMesh {
  std::size_t n_cells = 0;
  std::size_t n_inner = 0; ///< nodes whose cells are all of the material, and that are on no boundary
  std::optional<msm::LatticeModuli> wanted{};  ///< the material's; absent with a fibre along no axis
  msm::LatticeModuli uniform{};                ///< the springs', where every node follows a uniform strain
  std::optional<msm::LatticeModuli> relaxed{}; ///< where the inner nodes find their equilibrium
  std::string not_relaxed{};                   ///< why there are none
  /// msm::strain_misfit() of the cells' own springs; absent for a network, and without the material's moduli
  std::optional<double> median_misfit{}, worst_misfit{};
};

/// Motions of the free body that no spring resists, beside the rigid ones.
struct FreeMotions {
  int n = 0;
  bool are_more = false;    ///< n were looked for, and there may be more
  int n_unstable = 0;       ///< motions that give energy, among those looked for
  std::vector<int> nodes{}; ///< those that move; empty where there are more modes
};

struct DesignOnMesh {
  std::string design;
  std::string refusal{}; ///< why it does not apply; then the rest is empty
  std::string springs{}; ///< as springs_text() has them
  std::vector<MaterialOnMesh> materials{};
  std::optional<FreeMotions> motions{}; ///< absent without a matrix, and where they are not found
  std::vector<std::string> warnings{};
};

struct SpringsOnMesh {
  cases::Scene scene;
  std::vector<DesignOnMesh> designs{};
};

/// Whether the springs' matrix is made: not of a grid so large that it is solved without one.
bool is_matrix_made(const cases::Mesh& mesh);

/// Looks at no loads and supports, and solves nothing; one design after the other.
/// @param designs  empty: the case's own, whose refusal is thrown
/// @throws InputError when the case's own design cannot serve it
SpringsOnMesh study_on_mesh(const cases::Scene& scene, const std::vector<cases::Design>& designs);

void write_on_mesh_text(std::ostream& out, const SpringsOnMesh& study);

/// {"case", "shape", "body": as body_to_json(), "designs": [...]}
nlohmann::ordered_json on_mesh_to_json(const SpringsOnMesh& study);

/// Small-strain moduli of a cubic lattice, MPa, under the keys of `design --json`.
nlohmann::ordered_json moduli_to_json(const msm::LatticeModuli& moduli);

} // namespace springproof::compare
