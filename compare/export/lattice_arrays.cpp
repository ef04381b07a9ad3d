#include "compare/export/lattice_arrays.hpp"

namespace springproof::compare {

namespace {

/// Stiffness, rest length, law (0 Hooke, 1 power-log) and its parameter.
void add_spring(NumberArray& array, const msm::Spring& spring, const Units& units) {
  array.add({spring.stiffness * units.force / units.length, spring.rest_length * units.length,
             spring.law.kind == msm::LawKind::power_log ? 1. : 0., spring.law.parameter});
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
