#pragma once

#include "cases/case/solution.hpp"
#include "cases/mesh/fields.hpp"
#include "cases/scene/scene.hpp"

#include <cereal/archives/binary.hpp>
#include <cereal/types/variant.hpp>
#include <type_traits>

/// The fields of parsed cases, scenes and solutions, for cereal: see cases/mesh/fields.hpp.
namespace cereal {

/// Names and places of files are for messages: a worker needs them, a case's identity must not have them.
template<class Archive>
constexpr bool has_places = !std::is_same_v<Archive, BinaryOutputArchive>;

template<class Archive>
void serialize(Archive& archive, springproof::cases::Where& where) {
  auto& [file, line, column, key] = where;
  if constexpr (has_places<Archive>) archive(file, line, column, key);
}

template<class Archive>
void serialize(Archive& archive, springproof::cases::MeshFile& mesh) {
  auto& [path, where, scale] = mesh;
  archive(scale);
  if constexpr (has_places<Archive>) archive(path, where);
}

template<class Archive>
void serialize(Archive& archive, springproof::cases::NetworkFile& network) {
  auto& [path, where] = network;
  if constexpr (has_places<Archive>) archive(path, where);
}

SPRINGPROOF_FIELDS(springproof::cases::PictureContour, intensity, n_smoothing, most_triangles)

template<class Archive>
void serialize(Archive& archive, springproof::cases::BodySurface& surface) {
  auto& [path, contour, where, scale] = surface;
  archive(contour, scale);
  if constexpr (has_places<Archive>) archive(path, where);
}

template<class Archive>
void serialize(Archive& archive, springproof::cases::Voxels& voxels) {
  auto& [path, edge, where, scale] = voxels;
  archive(edge, scale);
  if constexpr (has_places<Archive>) archive(path, where);
}

SPRINGPROOF_FIELDS(springproof::cases::LabelClass, name, lower, upper, is_rigid)

template<class Archive>
void serialize(Archive& archive, springproof::cases::Labels& labels) {
  auto& [path, edge, classes, crop, keep, seed, where, scale] = labels;
  archive(edge, classes, crop, keep, seed, scale);
  if constexpr (has_places<Archive>) archive(path, where);
}

SPRINGPROOF_FIELDS(springproof::cases::Box, size, cells)
SPRINGPROOF_FIELDS(springproof::cases::LinearElastic, youngs_modulus, poissons_ratio)
SPRINGPROOF_FIELDS(springproof::cases::Ogden, mu, alpha, bulk_modulus)
SPRINGPROOF_FIELDS(springproof::cases::TransverselyIsotropic, youngs_modulus_along, youngs_modulus_across,
                   poissons_ratio_along, poissons_ratio_across, shear_modulus_along, fibre)
SPRINGPROOF_FIELDS(springproof::cases::History, points, frequency)
SPRINGPROOF_FIELDS(springproof::cases::MaterialDynamics, density, mass_damping, stiffness_damping)
SPRINGPROOF_FIELDS(springproof::cases::TimeScheme, scheme, beta, gamma, rho_infinity)
SPRINGPROOF_FIELDS(springproof::cases::Dynamics, scheme, step, end, start, write_every, where)
SPRINGPROOF_FIELDS(springproof::cases::RegionMaterial, material, group, lower, upper, where, dynamics)
SPRINGPROOF_FIELDS(springproof::cases::Part, cell_class, lower, upper, point, normal)
SPRINGPROOF_FIELDS(springproof::cases::Region, name, near, where, radius, part)
SPRINGPROOF_FIELDS(springproof::cases::Fixed, region, components)
SPRINGPROOF_FIELDS(springproof::cases::ScaledDisplacement, point, normal, length, where)
SPRINGPROOF_FIELDS(springproof::cases::Removed, lower, upper, join, where)
SPRINGPROOF_FIELDS(springproof::cases::RelaxationCounts, load_steps, per_step, further)
SPRINGPROOF_FIELDS(springproof::cases::Moved, region, components, displacement, angle, axis, centre, history,
                   scaled, steps)
SPRINGPROOF_FIELDS(springproof::cases::Load, region, kind, force, moment, axis, centre, history)
SPRINGPROOF_FIELDS(springproof::cases::AddedMass, region, mass)
SPRINGPROOF_FIELDS(springproof::cases::Fem, formulation, element, refine, has_auto_formulation,
                   has_auto_accuracy, accepted, mass, where)
SPRINGPROOF_FIELDS(springproof::cases::Msm, design, solver, law, exponent, poissons_ratio, split, stiffness,
                   axis_stiffness, uniform_stiffness, volume_stiffness, network, paths, weights, strain_range,
                   has_volume_term, accepted, mass, iterations_per_step, where, relaxation)
SPRINGPROOF_FIELDS(springproof::cases::Measure, name, kind, node, axis, component, top, bottom, toward,
                   centre, region, point, tensor_component, point_where, where, over_time, statistic)
SPRINGPROOF_FIELDS(springproof::cases::Landmark, name, point)
SPRINGPROOF_FIELDS(springproof::cases::Expectation, measure, quantity, interval, reference, reason, where,
                   ends_where)
SPRINGPROOF_FIELDS(springproof::cases::ExpectedOutcome, model, side, design, outcome, load_reached,
                   inverted_cells)
SPRINGPROOF_FIELDS(springproof::cases::Stiffer, axis, beyond, factor)
SPRINGPROOF_FIELDS(springproof::cases::Stress, is_heavy, start, amplitude, seed, stiffer, least_load_steps,
                   max_seconds, max_iterations, expected)

template<class Archive>
void serialize(Archive& archive, springproof::cases::Case& definition) {
  auto& [name, description, file, body, material, material_dynamics, region_materials, fixed, symmetry, moved,
         loads, masses, fem, msm, measures, expectations, stress, has_fields, dynamics, surface, landmarks,
         removed] = definition;
  archive(name, description, body, material, material_dynamics, region_materials, fixed, symmetry, moved,
          loads, masses, fem, msm, measures, expectations, stress, has_fields, dynamics, surface, landmarks,
          removed);
  if constexpr (has_places<Archive>) archive(file);
}

SPRINGPROOF_FIELDS(springproof::cases::Scene::ConstrainedNodes, selection, components)
SPRINGPROOF_FIELDS(springproof::cases::Scene::MovedNodes, selection, motion)
SPRINGPROOF_FIELDS(springproof::cases::CellPoint, cell, at, beyond)
SPRINGPROOF_FIELDS(springproof::cases::WeightedPoint, point, weight)
SPRINGPROOF_FIELDS(springproof::cases::Scene::AppliedLoad, selection, load, part, points)
SPRINGPROOF_FIELDS(springproof::cases::Scene::AppliedMass, selection, added)
SPRINGPROOF_FIELDS(springproof::cases::NetworkSpring, a, b, stiffness, rest_length, exponent)
template<class Archive>
void serialize(Archive& archive, springproof::cases::Scene& scene) {
  auto& [definition, mesh, material_of_cell, constrained, moved, loads, masses, network, surface, remarks] =
      scene;
  archive(definition, mesh, material_of_cell, constrained, moved, loads, masses, network, surface);
  if constexpr (has_places<Archive>) archive(remarks);
}

SPRINGPROOF_FIELDS(springproof::cases::Fields, reaction, total_energy, has_stress, strain_energy, stress,
                   strain)
SPRINGPROOF_FIELDS(springproof::cases::FromEquilibrium, tolerance, largest, root_mean_square, reason,
                   displacement)
SPRINGPROOF_FIELDS(springproof::cases::FieldNorms, root_mean_square, largest)
SPRINGPROOF_FIELDS(springproof::cases::Trajectory::Body, step, displacement)
SPRINGPROOF_FIELDS(springproof::cases::Vibration, omega, damping_ratio)
SPRINGPROOF_FIELDS(springproof::cases::Trajectory, time, nodes, displacement, volume, bodies, halved_steps,
                   unfinished_steps, largest_residual, slowest)

/// Who shares it is for the reader to know.
template<class Archive>
void serialize(Archive& archive, springproof::cases::Solution& solution) {
  auto& [status, message, outcome, displacement, cell_volume, fields, sharing, unknowns, residual,
         load_reached, newton_iterations, linear_iterations, relaxation_iterations, force_evaluations,
         factorisations, lowest_eigenvalue, negative_eigenvalues, inverted_cells, trajectory,
         from_equilibrium, norms] = solution;
  archive(status, message, outcome, displacement, cell_volume, fields, unknowns, residual, load_reached,
          newton_iterations, linear_iterations, relaxation_iterations, force_evaluations, factorisations,
          lowest_eigenvalue, negative_eigenvalues, inverted_cells, trajectory, from_equilibrium, norms);
}

} // namespace cereal
