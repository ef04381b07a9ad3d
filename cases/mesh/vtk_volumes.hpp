#pragma once

#include "cases/mesh/volume.hpp"

#include <string>

namespace springproof::cases {

/// Reads a file .nii, .nii.gz, .nrrd, .nhdr, .mha or .mhd by VTK, or .inv3.
/// @param most_bytes  of voxels that the file can hold
/// @throws std::runtime_error with VTK's message, or the reason
Volume read_volume(const std::string& path, std::uint64_t most_bytes);

} // namespace springproof::cases
