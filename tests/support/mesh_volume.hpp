#pragma once

#include "cases/mesh/mesh.hpp"

/// Volume of a mesh, mm³.
inline double volume_of(const springproof::cases::Mesh& mesh) {
  double volume = 0;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    volume += springproof::cases::cell_volume(springproof::cases::cell_corners(mesh, c));
  return volume;
}
