#include "msm/fields.hpp"

#include "mechanics/field_sums.hpp"

#include <cassert>

namespace springproof::msm {

namespace {

using cases::index;
using Eigen::Vector3d;

/// A cell as its first vertex sees it, at rest and displaced: far from the origin positions have lost digits.
struct SeenCell {
  CellPositions rest, motion, now; ///< mm
  /// @param displacement  of the nodes from first_node on
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

/// Gradient of a cell's energy with respect to its vertices, N; the energy is added to `energy`, N mm.
CellPositions cell_gradient(const CellTerms& terms, const SeenCell& cell, double rest_volume,
                            double& energy) {
  CellPositions force;
  force.fill(Vector3d::Zero());
  for (const auto& [vertices, stiffness, exponent] : terms.springs) {
    if (stiffness == 0) continue;
    const auto from = index(vertices[0]), to = index(vertices[1]);
    const Spring spring{stiffness, (cell.rest[to] - cell.rest[from]).norm(), exponent};
    const Vector3d along = cell.now[to] - cell.now[from], pull = spring_force(along, spring);
    force[from] -= pull;
    force[to] += pull;
    energy += spring_energy(along, spring);
  }
  for (const auto& [vertices, lambda, mu] : terms.tetrahedra) {
    const Tetrahedron made =
        make_tetrahedron(vertices, Points(cell.rest.begin(), cell.rest.end()), lambda, mu);
    const TetrahedronPositions now = tetrahedron_positions(made, Points(cell.now.begin(), cell.now.end()));
    const auto pulls = biquadratic_forces(now, made.rest_lengths, made.stiffness);
    for (std::size_t v = 0; v < 4; ++v) force[index(vertices[v])] -= pulls[v];
    energy += biquadratic_energy(now, made.rest_lengths, made.stiffness);
  }
  if (terms.volume == 0) return force;
  const VolumeLaw law = volume_law(trilinear_volume(cell.now) / rest_volume, terms.is_logarithmic);
  const auto gradient = trilinear_volume_gradient(cell.now);
  for (std::size_t v = 0; v < 8; ++v) force[v] += terms.volume * law.pressure * gradient[v];
  energy += terms.volume * rest_volume * law.integral;
  return force;
}

/// What there is to say of a cell without its springs.
void add_shape(mechanics::CellSums& sum, const SeenCell& cell) {
  sum.rest_volume() = trilinear_volume(cell.rest);
  sum.volume() = trilinear_volume(cell.now);
  const auto mean_gradient = trilinear_volume_gradient(cell.rest); // integrals of grad N_a, mm²
  for (std::size_t v = 0; v < 8; ++v) sum.gradient() += cell.motion[v] * mean_gradient[v].transpose();
}

/// @param for_each  for_each(range, action) calls action(number, terms) for cells
template<class ForEachCell>
cases::Fields fields_of_cells(const cases::Scene& scene, const cases::Solution& solution, double load_factor,
                              const ForEachCell& for_each) {
  const cases::Sharing* const sharing = solution.sharing.get();
  const cases::Share here = cases::share_here(scene.mesh, sharing);
  mechanics::FieldSums sums(here.nodes, here.cells);
  for_each(here.cells, [&](std::size_t c, const CellTerms& terms) {
    const SeenCell cell(scene.mesh, c, solution.displacement, here.nodes.begin);
    mechanics::CellSums& sum = sums.cell(c);
    add_shape(sum, cell);
    const CellPositions force = cell_gradient(terms, cell, sum.rest_volume(), sum.energy());
    const std::array<int, 8> nodes = scene.mesh.cells[c];
    for (std::size_t v = 0; v < 8; ++v) {
      sum.virial() += force[v] * cell.now[v].transpose();
      sums.force(index(nodes[v])) += force[v];
    }
  });
  return mechanics::fields_of(scene, std::move(sums), sharing, load_factor,
                              mechanics::StrainMeasure::logarithmic, scene.definition.msm.mass);
}

} // namespace

cases::Fields fields(const cases::Scene& scene, const std::vector<CellStiffness>& stiffness,
                     const cases::Solution& solution, double load_factor) {
  assert(stiffness.size() == 1 || stiffness.size() == scene.mesh.cells.size());
  return fields_of_cells(scene, solution, load_factor, [&](const cases::Range& cells, const auto& action) {
    CellTerms terms = terms_of(stiffness.front());
    for (std::size_t c = cells.begin; c < cells.end; ++c) {
      if (stiffness.size() > 1) terms = terms_of(stiffness[c]);
      action(c, terms);
    }
  });
}

cases::Fields fields(const cases::Scene& scene, const BodyTerms& terms, const cases::Solution& solution,
                     double load_factor) {
  return fields_of_cells(scene, solution, load_factor, [&](const cases::Range& cells, const auto& action) {
    for_each_cell(scene.mesh, terms, cells, action);
  });
}

cases::Fields network_fields(const cases::Scene& scene, const Lattice& network,
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
      mechanics::fields_of(scene, std::move(sums), sharing, load_factor,
                           mechanics::StrainMeasure::logarithmic, scene.definition.msm.mass);
  fields.total_energy = energy_at(network, all);
  fields.has_stress = false;
  fields.strain_energy.clear();
  fields.stress.clear();
  return fields;
}

} // namespace springproof::msm
