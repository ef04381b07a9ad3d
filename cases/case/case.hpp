#pragma once

#include "cases/case/boundary.hpp"
#include "cases/case/hard.hpp"
#include "cases/case/material.hpp"
#include "cases/case/measure.hpp"
#include "cases/case/models.hpp"
#include "cases/case/tool.hpp"

#include <cmath>

/// The shared vocabulary: what a case file says, as plain values. Units: mm, N, MPa, degrees.
namespace springproof::cases {

/// The surface that divides the intensities of a picture.
struct PictureContour {
  double intensity;
  int n_smoothing;            ///< passes of a filter; 0: none
  std::size_t most_triangles; ///< about so many at most; 0: all
};
SPRINGPROOF_FIELDS(PictureContour, intensity, n_smoothing, most_triangles)

/// A surface that the body takes along, such as a skin that the cells follow in steps: triangles of a file
/// (STL, VTP), or the contour of the picture that the body is made of.
struct BodySurface {
  NamedFile file; ///< surface or picture
  std::optional<PictureContour> contour;
  double scale = 1; ///< mm of a unit of the file
};
SPRINGPROOF_FIELDS(BodySurface, file, contour, scale)

/// A place of the body's surface at which the surfaces of both models are compared.
struct Landmark {
  std::string name;
  Eigen::Vector3d point; ///< mm, with the body at rest, on its surface or near it
};
SPRINGPROOF_FIELDS(Landmark, name, point)

struct Case {
  std::string name;
  std::string description;
  std::string file;
  Body body;
  std::optional<Body> fem_body{}; ///< the finite elements' own, beside a network
  Material material;
  MaterialDynamics material_dynamics;
  std::vector<RegionMaterial> region_materials; ///< a cell in several of them has the last one's
  std::vector<Fixed> fixed;
  std::vector<Fixed> symmetry; ///< region = a face of a box, components = its normal alone
  std::vector<Moved> moved;
  std::vector<Load> loads; ///< may be empty when something is moved
  std::vector<AddedMass> masses;
  Fem fem;
  Msm msm;
  std::vector<Measure> measures;
  std::vector<Expectation> expectations;
  std::optional<Stress> stress; ///< hard cases only
  bool has_fields = false;      ///< solutions get their fields: a measure or a file of results needs them
  std::optional<Dynamics> dynamics;
  std::optional<BodySurface> surface{}; ///< absent: the outer one of the cells
  std::vector<Landmark> landmarks{};
  std::vector<Removed> removed{}; ///< cut out of the body
  std::vector<Tool> tools{};
};

template<class Archive>
void serialize(Archive& archive, Case& definition) {
  auto& [name, description, file, body, fem_body, material, material_dynamics, region_materials, fixed,
         symmetry, moved, loads, masses, fem, msm, measures, expectations, stress, has_fields, dynamics,
         surface, landmarks, removed, tools] = definition;
  archive(name, description, body, fem_body, material, material_dynamics, region_materials, fixed, symmetry,
          moved, loads, masses, fem, msm, measures, expectations, stress, has_fields, dynamics, surface,
          landmarks, removed, tools);
  if constexpr (has_places<Archive>) archive(file);
}

/// Whether the body's own material, or that of a region, damps by its stiffness.
inline bool has_stiffness_damping(const Case& definition) {
  bool has = definition.material_dynamics.stiffness_damping > 0;
  for (const RegionMaterial& region : definition.region_materials)
    has = has || region.dynamics.stiffness_damping > 0;
  return has;
}

/// What a material adds to its elasticity.  @param material  as materials_of() numbers them
inline const MaterialDynamics& dynamics_of(const Case& definition, std::size_t material) {
  return material == 0 ? definition.material_dynamics : definition.region_materials[material - 1].dynamics;
}

/// Whether the body's own material, or that of a region, has a Prony series.
inline bool has_memory(const Case& definition) {
  bool has = false;
  for (std::size_t m = 0; m <= definition.region_materials.size(); ++m)
    has = has || !dynamics_of(definition, m).prony.empty();
  return has;
}

/// Whether there is a body that finite elements can be made of.
inline bool has_finite_elements(const Case& definition) {
  return has_cells(definition.body) || definition.fem_body;
}

/// Refuses what a network cannot have.
/// @param what  such as "a sweep"    @param instead  what to do
/// @throws InputError, at the network's nodes
void refuse_network(const Case& definition, const std::string& what, const std::string& instead);

/// Refuses tools where nothing knows them.
/// @param beside  such as "--client"    @param reason  why, or what to do
/// @throws InputError, at the first tool
void refuse_tools(const Case& definition, const std::string& beside, const std::string& reason);

/// @throws InputError if there is no body that finite elements can be made of
void check_finite_elements(const Case& definition);

/// The body's own material, then those of its regions.
inline std::vector<Material> materials_of(const Case& definition) {
  std::vector<Material> materials{definition.material};
  for (const RegionMaterial& region : definition.region_materials) materials.push_back(region.material);
  return materials;
}

/// Degrees. Small strains depend on where a turned region ends, not on its way: a larger turn ends where a
/// smaller one the other way does.
constexpr double largest_turn_of_small_strain = 180;

/// The largest angle that a region is turned by, degrees, >= 0.
inline double largest_turn(const Case& definition) {
  double largest = 0;
  for (const Moved& moved : definition.moved) largest = std::max(largest, std::abs(moved.angle));
  return largest;
}

/// Degrees in one step of the load or of time. Where a turned support ends says nothing about whole turns:
/// only small steps lead the body around with it. A straight guess then leaves the arc by 15 % of the radius.
constexpr double largest_turn_of_step = 30;

/// @throws InputError for a region that turns by more than largest_turn_of_step within a step in time, with
/// the largest step that is short enough
void check_turns_in_time(const Case& definition);

/// The factor with the largest magnitude in a whole motion; 1 in a static case.
double largest_factor(const Moved& moved, const std::optional<Dynamics>& dynamics);

/// Load steps that the motions and the tools ask for.
inline int least_load_steps(const Case& definition) {
  int steps = 1;
  for (const Moved& moved : definition.moved) steps = std::max(steps, moved.steps);
  for (const Tool& tool : definition.tools) steps = std::max(steps, tool.steps);
  return steps;
}

} // namespace springproof::cases
