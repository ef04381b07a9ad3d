#pragma once

#include "cases/case/case.hpp"
#include "cases/case/toml_table.hpp"

/// The readers of a case file's tables. Each takes a case in which the tables before it are read, and throws
/// InputError.
namespace springproof::cases {

// [body]

/// Reads [body].  @param case_path  the case file's; names of files are relative to it
Body read_body(Table& table, const std::string& case_path);

/// Reads [fem.body], the finite elements' own beside a network, into a case whose body is read.
std::optional<Body> read_fem_body(Table& root, const Case& definition);

/// @throws InputError where a case that is read asks a network for faces or cells
void check_network(Table& root, const Case& definition);

std::vector<std::string> names_of(const std::vector<LabelClass>& classes);

/// Reads `scale`: mm of a unit of a file, 1 where it is left out.
double read_scale(Table& table);

// [material] and [[region_material]]

/// Poisson's ratio of an isotropic material.
inline constexpr auto is_poissons_ratio = [](double value) { return value > -1 && value < 0.5; };

/// Mooney-Rivlin's law, W = C10 (I1 - 3) + C01 (I2 - 3), in Ogden's terms; neo-Hookean: C01 = 0.
/// @param c10, c01, bulk_modulus  MPa
inline Ogden mooney_rivlin(double c10, double c01, std::optional<double> bulk_modulus = std::nullopt) {
  if (c01 == 0) return {{2 * c10}, {2}, bulk_modulus};
  return {{2 * c10, 2 * c01}, {2, -2}, bulk_modulus};
}

/// Reads the materials into a case whose body and [dynamics] are read.  @throws InputError
void read_materials(Table& root, Case& result);

// Regions, supports, motions, loads and masses

/// Reads a region from a text: "z+ x-", "near 5 5 10", or the name of a physical group.
Region read_region_text(const Entry& entry, const Body& body);

/// Reads a region from a text, or from a table of a part or a plane.
Region read_region_entry(const Entry& entry, const Body& body);

/// Reads nearest = [...], tolerance = 2: the node nearest to a point, if it is that near.
Region read_nearest(Table& table);

/// Reads a unit vector: "x", "y", "z", or any direction.
Eigen::Vector3d read_direction(const Entry& entry);

/// Reads a region from a table: `region`, a text or a table of a part or a plane; the node at `near`, or with
/// `radius` the patch around it; or read_nearest().
Region read_region(Table& table, const Body& body);

/// Reads supports, motions, loads and masses into a case whose body and [dynamics] are read.
void read_boundary(Table& root, Case& result);

/// @throws InputError where nothing holds the body, or nothing moves it
void check_boundary(Table& root, const Case& result);

/// @throws InputError where small strains meet a larger turn than they know, in a case whose models are read
void check_turns(const Case& definition);

// [[tool]]

/// Reads the name of one of the tools.  @return its index
std::size_t read_tool_index(const Entry& entry, const std::vector<Tool>& tools);

/// Reads the tools into a case whose body is read.
void read_tools(Table& root, Case& result);

/// @throws InputError where tools stand beside what does not know them, in a case whose models are read
void check_tools(const Case& definition);

// [dynamics], and what a case says of time elsewhere

/// Reads [dynamics], where there is one.
std::optional<Dynamics> read_dynamics(Table& root);

/// Reads density, mass_damping and stiffness_damping in a material's table.
MaterialDynamics read_material_dynamics(Table& table, bool has_dynamics);

/// Reads the history of a load or motion; the key is refused in a static case.
History read_history(Table& table, bool has_dynamics);
/// Refuses a sine that the case's steps cannot follow.  @param key, i  of the table, for the message
void check_sine(const History& history, const Dynamics& dynamics, const std::string& key, std::size_t i);

/// Reads over_time of a measure.
std::optional<OverTime> read_over_time(Table& table, const measures::Kind& kind, bool has_dynamics);

/// Checks a case that is read up to here: densities where masses are asked for, motions that have a
/// beginning, and keys that have no meaning in a motion.
void check_dynamics(Table& root, const Case& definition);

// [fem] and [msm]

/// Reads them into a case whose body, [dynamics] and materials are read.
/// @throws InputError, also if a material has no meaning in the element, or the springs' design does not
/// exist for it
void read_models(Table& root, Case& result);

/// The design that we recommend for a body of these materials: the default of [msm] without `design`, and
/// that for `design` without --method. Transversely isotropic: "transverse"; nu < 0: "moduli"; otherwise
/// "midline". Under forces on single nodes, which have no continuum limit, springs are held against finite
/// elements of the same mesh, and "midline" gives way too much at a loaded node: there it is "matched" where
/// its lattice is stable over the strains of its exponents (logarithmic strain with nu from 0.25 to 0.35, and
/// Ogden), else "hybrid".
/// @param materials  at least one    @param poissons_ratio  the design's, in place of the materials'
Design default_design(const std::vector<Material>& materials,
                      std::optional<double> poissons_ratio = std::nullopt, bool has_nodal_forces = false);

} // namespace springproof::cases
