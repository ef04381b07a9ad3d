#pragma once

#include "cases/mesh/volume.hpp"
#include "cases/mesh/volume_files.hpp"

#include <string>

namespace springproof::cases {

/// Reads a project of InVesalius: a gzipped tar whose main.plist names the file of the voxels, int16, least
/// byte first, its shape (z, y, x) and the spacing (x, y, z).
/// @throws std::runtime_error if it is none
Volume read_inv3(const std::string& path, const VolumeBytes& bytes);

} // namespace springproof::cases
