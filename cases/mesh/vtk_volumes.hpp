#pragma once

#include "cases/mesh/volume.hpp"
#include "cases/mesh/volume_files.hpp"

#include <string>

namespace springproof::cases {

/// Reads a file .nii, .nii.gz, .nrrd, .nhdr, .mha or .mhd by VTK, or .inv3.
/// @param bytes  of its files; compressed ones are inflated twice, to check them first
/// @throws std::runtime_error with VTK's message, or the reason
Volume read_volume(const std::string& path, const VolumeBytes& bytes);

} // namespace springproof::cases
