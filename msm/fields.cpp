#include "msm/fields.hpp"

#include "mechanics/field_sums.hpp"

#include <algorithm>

namespace springproof::msm {

namespace {

using cases::index;
using Eigen::Vector3d;

/// A cell as its first vertex sees it, at rest and displaced: far from the origin positions have lost digits.
struct SeenCell {
  CellPositions rest, motion, now; ///< mm
  /// @param displacement  one per node from first_node on
  SeenCell(const cases::HexMesh& mesh, std::size_t cell, const Points& displacement, std::size_t first_node) {
    const std::array<int, 8> nodes = mesh.cells[cell];
    const auto moved = [&](int node) -> const Vector3d& { return displacement[index(node) - first_node]; };
    const Vector3d corner = mesh.nodes[index(nodes[0])];
    for (std::size_t v = 0; v < 8; ++v) {
      rest[v] = mesh.nodes[index(nodes[v])] - corner;
      motion[v] = moved(nodes[v]) - moved(nodes[0]);
      now[v] = rest[v] + motion[v];
    }
  }
};

/// Adds what a cell is without its springs.
void add_shape(mechanics::CellSums& sum, const SeenCell& cell) {
  sum.rest_volume() = trilinear_volume(cell.rest);
  sum.volume() = trilinear_volume(cell.now);
  const auto mean_gradient = trilinear_volume_gradient(cell.rest); // integrals of grad N_a, mm²
  for (std::size_t v = 0; v < 8; ++v) sum.gradient() += cell.motion[v] * mean_gradient[v].transpose();
}

mechanics::FieldsOf how_of(const cases::Scene& scene, const cases::Solution& solution, double load_factor) {
  return {load_factor, mechanics::StrainMeasure::logarithmic, scene.definition.msm.mass,
          solution.status == cases::Status::converged && solution.is_equilibrium()
              ? mechanics::Balance::at_nodes
              : mechanics::Balance::not_asked};
}

cases::Fields fields_of_cells(const cases::Scene& scene, const SpringBody& springs,
                              const cases::Solution& solution, double load_factor) {
  const cases::Sharing* const sharing = solution.sharing.get();
  const cases::Share here = cases::share_here(scene.mesh, sharing);
  mechanics::FieldSums sums(here.nodes, here.cells);
  for_each_cell(scene.mesh, springs, here.cells, [&](std::size_t c, const CellTerms& terms) {
    const SeenCell cell(scene.mesh, c, solution.displacement, here.nodes.begin);
    mechanics::CellSums& sum = sums.cell(c);
    add_shape(sum, cell);
    const Lattice lattice = cell_lattice(terms, cell.rest);
    const Points motion(cell.motion.begin(), cell.motion.end()), force = internal_force_at(lattice, motion);
    sum.energy() += energy_at(lattice, motion);
    const std::array<int, 8> nodes = scene.mesh.cells[c];
    for (std::size_t v = 0; v < 8; ++v) {
      sum.virial() -= force[v] * cell.now[v].transpose();
      sums.force(index(nodes[v])) -= force[v];
    }
  });
  return mechanics::fields_of(scene, std::move(sums), sharing, how_of(scene, solution, load_factor));
}

cases::Fields fields_of_network(const cases::Scene& scene, const Lattice& network,
                                const cases::Solution& solution, double load_factor) {
  const cases::Sharing* const sharing = solution.sharing.get();
  const cases::Share here = cases::share_here(scene.mesh, sharing);
  mechanics::FieldSums sums(here.nodes, here.cells);
  for (std::size_t c = here.cells.begin; c < here.cells.end; ++c)
    add_shape(sums.cell(c), SeenCell(scene.mesh, c, solution.displacement, here.nodes.begin));
  // A spring may end anywhere: every rank, which has all springs, takes all nodes for once.
  const Points all = sharing ? sharing->gather(solution.displacement) : solution.displacement;
  const Points force = internal_force_at(network, all);
  for (std::size_t node = here.own_nodes.begin; node < here.own_nodes.end; ++node)
    sums.force(node) = -force[node];
  cases::Fields fields =
      mechanics::fields_of(scene, std::move(sums), sharing, how_of(scene, solution, load_factor));
  fields.total_energy = energy_at(network, all);
  fields.has_stress = false;
  fields.strain_energy.clear();
  fields.stress.clear();
  return fields;
}

} // namespace

cases::Fields fields(const cases::Scene& scene, const SpringBody& springs, const cases::Solution& solution,
                     double load_factor) {
  return springs.network()
             ? fields_of_network(scene, make_lattice(scene.mesh, springs), solution, load_factor)
             : fields_of_cells(scene, springs, solution, load_factor);
}

} // namespace springproof::msm
