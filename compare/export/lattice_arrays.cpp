#include "compare/export/lattice_arrays.hpp"

#include <stdexcept>

namespace springproof::compare {

namespace {

#pragma GCC diagnostic error "-Wswitch" // a law without a number must not compile
/// The number by which clients and packages know a law.
double number_of(msm::LawKind law) {
  switch (law) {
  case msm::LawKind::hooke:
    return 0;
  case msm::LawKind::power_log:
    return 1;
  }
  throw std::logic_error("a law without a number");
}

/// Stiffness, rest length, number of the law, and its parameter.
void add_spring(NumberArray& array, const msm::Spring& spring, const Units& units) {
  array.add({spring.stiffness * units.force / units.length, spring.rest_length * units.length,
             number_of(spring.law.kind), spring.law.parameter});
}

/// k_v, volume at rest, whether it is logarithmic: of a cell or of a node's tetrahedra.
template<class Term>
void add_volume_law(NumberArray& array, const Term& term, const Units& units) {
  const double length = units.length;
  array.add({term.stiffness * units.force / (length * length), term.rest_volume * length * length * length,
             term.is_logarithmic ? 1. : 0.});
}

} // namespace

std::vector<NamedArray> lattice_arrays(const msm::Lattice& lattice, const Units& units) {
  NumberArray springs{6}, midlines{13}, tetrahedra{46}, hexahedra{11}, patches{3}, patch_tetrahedra{5};
  for (const msm::Link& link : lattice.links) {
    springs.add_nodes(msm::nodes_of(link));
    add_spring(springs, link.spring, units);
  }
  for (const msm::Midline& midline : lattice.midlines) {
    midlines.add_nodes(midline.nodes);
    midlines.add({double(midline.axis)});
    add_spring(midlines, midline.spring, units);
  }
  const double per_volume = units.force / (units.length * units.length * units.length);
  for (const msm::Tetrahedron& one : lattice.tetrahedra) {
    tetrahedra.add_nodes(one.nodes);
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) tetrahedra.add({one.stiffness(i, j) * per_volume});
    for (int i = 0; i < 6; ++i) tetrahedra.add({one.rest_lengths[i] * units.length});
  }
  for (const msm::VolumeCell& cell : lattice.volume_cells) {
    hexahedra.add_nodes(cell.nodes);
    add_volume_law(hexahedra, cell, units);
  }
  for (std::size_t p = 0; p < lattice.volume_patches.size(); ++p) {
    const msm::VolumePatch& patch = lattice.volume_patches[p];
    add_volume_law(patches, patch, units);
    for (const std::array<int, 4>& places : patch.tetrahedra) {
      patch_tetrahedra.add({double(p)});
      patch_tetrahedra.add_nodes(cases::pick(patch.nodes, places));
    }
  }
  return {{"springs", springs},
          {"midlines", midlines},
          {"biquadratic_tetrahedra", tetrahedra},
          {"volume_hexahedra", hexahedra},
          {"volume_patches", patches},
          {"volume_patch_tetrahedra", patch_tetrahedra}};
}

} // namespace springproof::compare
