#pragma once

#include "cases/case/solution.hpp"
#include "cases/mesh/fields.hpp"
#include "cases/scene/scene.hpp"

#include <cereal/archives/binary.hpp>
#include <cereal/types/variant.hpp>

/// The fields of scenes and solutions, for cereal: see cases/mesh/fields.hpp.
namespace cereal {

SPRINGPROOF_FIELDS(springproof::cases::Scene::ConstrainedNodes, selection, components)
SPRINGPROOF_FIELDS(springproof::cases::Scene::MovedNodes, selection, motion)
SPRINGPROOF_FIELDS(springproof::cases::CellPoint, cell, at, beyond)
SPRINGPROOF_FIELDS(springproof::cases::WeightedPoint, point, weight)
SPRINGPROOF_FIELDS(springproof::cases::Scene::AppliedLoad, selection, load, part, points)
SPRINGPROOF_FIELDS(springproof::cases::Scene::AppliedMass, selection, added)
SPRINGPROOF_FIELDS(springproof::cases::NetworkSpring, a, b, stiffness, rest_length, exponent)
template<class Archive>
void serialize(Archive& archive, springproof::cases::Scene& scene) {
  auto& [definition, mesh, material_of_cell, constrained, moved, loads, masses, network, node_masses, of_fem,
         surface, remarks] = scene;
  archive(definition, mesh, material_of_cell, constrained, moved, loads, masses, network, node_masses, of_fem,
          surface);
  if constexpr (springproof::cases::has_places<Archive>) archive(remarks);
}

SPRINGPROOF_FIELDS(springproof::cases::Fields, reaction, total_energy, has_stress, strain_energy, stress,
                   strain)
SPRINGPROOF_FIELDS(springproof::cases::ToolContact, force, torque, area, penetration, nodes, on_nodes)
SPRINGPROOF_FIELDS(springproof::cases::FromEquilibrium::Rest, time, steps)
SPRINGPROOF_FIELDS(springproof::cases::FromEquilibrium, tolerance, largest, root_mean_square, reason,
                   displacement, rest)
SPRINGPROOF_FIELDS(springproof::cases::FieldNorms, root_mean_square, largest)
SPRINGPROOF_FIELDS(springproof::cases::Trajectory::Body, step, displacement)
SPRINGPROOF_FIELDS(springproof::cases::Vibration, omega, damping_ratio)
SPRINGPROOF_FIELDS(springproof::cases::Trajectory, time, nodes, displacement, volume, tools, bodies,
                   halved_steps, unfinished_steps, largest_residual, slowest)

/// Leaves out `sharing`, which the reader has to know.
template<class Archive>
void serialize(Archive& archive, springproof::cases::Solution& solution) {
  auto& [status, message, outcome, displacement, cell_volume, fields, sharing, unknowns, residual,
         load_reached, newton_iterations, linear_iterations, relaxation_iterations, force_evaluations,
         factorisations, lowest_eigenvalue, negative_eigenvalues, inverted_cells, trajectory,
         from_equilibrium, tools, norms] = solution;
  archive(status, message, outcome, displacement, cell_volume, fields, unknowns, residual, load_reached,
          newton_iterations, linear_iterations, relaxation_iterations, force_evaluations, factorisations,
          lowest_eigenvalue, negative_eigenvalues, inverted_cells, trajectory, from_equilibrium, tools,
          norms);
}

} // namespace cereal
