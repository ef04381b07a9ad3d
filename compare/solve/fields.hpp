#pragma once

#include "cases/case/solution.hpp"
#include "cases/scene/scene.hpp"
#include "msm/design/design.hpp"

#include <cereal/archives/binary.hpp>
#include <cereal/archives/portable_binary.hpp>
#include <cereal/types/array.hpp>
#include <cereal/types/map.hpp>
#include <cereal/types/optional.hpp>
#include <cereal/types/string.hpp>
#include <cereal/types/variant.hpp>
#include <cereal/types/vector.hpp>
#include <sstream>
#include <type_traits>

/// The fields of all values that are kept in files or sent to worker processes, for cereal. Portable binary
/// and not JSON: displacements keep their last bit, in a third of the bytes. To be included by the few
/// sources that keep or send; cereal is slow to compile.

/// Lists every field of a type in its order. A field that is added to the type and not here does not compile.
#define SPRINGPROOF_FIELDS(Type, ...)                                                                        \
  template<class Archive>                                                                                    \
  void serialize(Archive& archive, Type& value) {                                                            \
    auto& [__VA_ARGS__] = value;                                                                             \
    archive(__VA_ARGS__);                                                                                    \
  }

namespace cereal { // where cereal looks for them, whatever the type's own namespace

namespace sp = springproof;

template<class Archive>
void serialize(Archive& archive, Eigen::Vector3d& vector) {
  archive(binary_data(vector.data(), 3 * sizeof(double)));
}

/// Names and places of files are for messages: a worker needs them, a case's identity must not have them.
template<class Archive>
constexpr bool has_places = !std::is_same_v<Archive, BinaryOutputArchive>;

template<class Archive>
void serialize(Archive& archive, sp::cases::Where& where) {
  auto& [file, line, column, key] = where;
  if constexpr (has_places<Archive>) archive(file, line, column, key);
}

template<class Archive>
void serialize(Archive& archive, sp::cases::MeshFile& mesh) {
  auto& [path, where] = mesh;
  if constexpr (has_places<Archive>) archive(path, where);
}

template<class Archive>
void serialize(Archive& archive, sp::cases::Voxels& voxels) {
  auto& [path, edge, where] = voxels;
  archive(edge);
  if constexpr (has_places<Archive>) archive(path, where);
}

SPRINGPROOF_FIELDS(sp::cases::Box, size, cells)
SPRINGPROOF_FIELDS(sp::cases::LinearElastic, youngs_modulus, poissons_ratio)
SPRINGPROOF_FIELDS(sp::cases::Ogden, mu, alpha, bulk_modulus)
SPRINGPROOF_FIELDS(sp::cases::RegionMaterial, material, group, lower, upper, where)
SPRINGPROOF_FIELDS(sp::cases::Region, name, near, where, radius)
SPRINGPROOF_FIELDS(sp::cases::Fixed, region, components)
SPRINGPROOF_FIELDS(sp::cases::Moved, region, components, displacement, angle, axis, centre)
SPRINGPROOF_FIELDS(sp::cases::Load, region, kind, force, moment, axis, centre)
SPRINGPROOF_FIELDS(sp::cases::Fem, formulation, element, refine, has_auto_formulation, has_auto_accuracy,
                   where)
SPRINGPROOF_FIELDS(sp::cases::Msm, design, solver, poissons_ratio, split, stiffness, volume_stiffness, paths,
                   weights, strain_range, has_volume_term, where)
SPRINGPROOF_FIELDS(sp::cases::Measure, name, kind, node, axis, component, top, bottom, toward, centre, where)
SPRINGPROOF_FIELDS(sp::cases::Expectation, measure, quantity, interval, reference, reason, where,
                   interval_where)

template<class Archive>
void serialize(Archive& archive, sp::cases::Case& definition) {
  auto& [name, description, file, body, material, region_materials, fixed, symmetry, moved, loads, fem, msm,
         measures, expectations] = definition;
  archive(name, description, body, material, region_materials, fixed, symmetry, moved, loads, fem, msm,
          measures, expectations);
  if constexpr (has_places<Archive>) archive(file);
}

SPRINGPROOF_FIELDS(sp::cases::Selection, nodes, edges, faces)
SPRINGPROOF_FIELDS(sp::cases::Grid, cells, spacing, origin, present)
SPRINGPROOF_FIELDS(sp::cases::HexMesh, nodes, cells, groups, group_of_cell, grid)
SPRINGPROOF_FIELDS(sp::cases::Scene::FixedNodes, selection, components)
SPRINGPROOF_FIELDS(sp::cases::Scene::MovedNodes, selection, motion)
SPRINGPROOF_FIELDS(sp::cases::Scene::AppliedLoad, selection, load)
SPRINGPROOF_FIELDS(sp::cases::Scene, definition, mesh, material_of_cell, fixed, moved, loads)

SPRINGPROOF_FIELDS(sp::cases::Solution, status, message, outcome, displacement, cell_volume, unknowns,
                   residual, load_reached, newton_iterations, linear_iterations, relaxation_iterations,
                   force_evaluations, factorisations, lowest_eigenvalue, negative_eigenvalues, inverted_cells)
SPRINGPROOF_FIELDS(sp::msm::CellStiffness, edge, face_diagonal, internal_diagonal, volume)
SPRINGPROOF_FIELDS(sp::msm::LatticeModuli, c11, c12, c44, zener, youngs_modulus, poissons_ratio,
                   shear_modulus)
SPRINGPROOF_FIELDS(sp::msm::DesignResult, stiffness, residual, moduli, warnings, cells)

} // namespace cereal

namespace springproof::compare {

/// Values as bytes, which from_bytes() takes over to the last bit.
template<class Archive = cereal::PortableBinaryOutputArchive, class... Values>
std::string to_bytes(const Values&... values) {
  std::ostringstream stream;
  Archive archive(stream);
  archive(values...);
  return stream.str();
}

/// @throws std::exception if these are not the bytes of such values
template<class... Values>
void from_bytes(const std::string& bytes, Values&... values) {
  std::istringstream stream(bytes);
  cereal::PortableBinaryInputArchive archive(stream);
  archive(values...);
  if (stream.peek() != std::istringstream::traits_type::eof()) throw cereal::Exception("bytes are left over");
}

} // namespace springproof::compare
