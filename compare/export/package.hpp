#pragma once

#include "compare/export/lattice_arrays.hpp"
#include "mechanics/surface/embedded_surface.hpp"

/// What packages for several programs have in common: references of the forces, and a skin.
namespace springproof::compare {

/// How many terms a lattice has beside springs of Hooke's law.
std::size_t n_other_terms(const msm::Lattice& lattice);

/// Writes the tetrahedra that stand in for volume terms of hexahedra: the two that are inscribed in each. A
/// parallelepiped's volume changes by the mean of their parts, to first order.
void write_volume_tetrahedra_csv(const std::string& folder, const msm::Lattice& lattice);

/// Rows of vertex, node and weight, which is not 0: a vertex is at the weighted sum of its nodes.
NumberArray skin_weights(const mechanics::EmbeddedSurface& skin);

/// Writes a skin's triangles and weights.  @return what was written
std::string write_skin_csv(const std::string& folder, const mechanics::EmbeddedSurface& skin);

/// Copies a program that comes with this one.  @param data  its data_folder()
void copy_program(const std::string& folder, const std::string& data, const std::string& name,
                  const std::string& as);

/// Writes forces.py, the forces in NumPy, and check.csv, a deformed state with its forces.
/// @param force  the package's unit of force, of them in a N: 1 or 1000  @return what was written
std::string write_references(const std::string& folder, const msm::Lattice& lattice, double force);

} // namespace springproof::compare
