#pragma once

#include "cases/mesh/deflated.hpp"

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>

namespace springproof::cases {

/// What the header of a NRRD (.nrrd, .nhdr) or MetaImage (.mha, .mhd) says of its voxels.
struct VolumeHeader {
  std::string file; ///< that they are in; empty: the same file
  bool is_compressed = false;
  Eigen::Vector3d voxel{0, 0, 0}; ///< its edges, mm
  std::uint64_t bytes = 0;        ///< of the header
  std::uint64_t skipped = 0;      ///< of what stands before the voxels, MetaImage's HeaderSize
  std::uint64_t compressed = 0;   ///< of the compressed voxels, where the header says that
};

/// @param beginning  of the file
/// @throws std::runtime_error if it lacks what its format requires or has it in a form that is not read, if
/// it names several files, or one that is not in the header's own folder, if it says no size of its voxels in
/// a unit of length that is known, or one that is none, or if they are sheared
VolumeHeader header_of_volume(const std::string& beginning);

/// The files of a picture.
struct VolumeBytes {
  std::uint64_t in_files;                ///< of the file and of the one beside it that it names
  std::uint64_t of_voxels;               ///< that they can hold: deflate makes of a byte 1032 at most
  std::optional<Deflated> deflated = {}; ///< voxels, of .nii.gz and .inv3 the whole file
  Eigen::Vector3d voxel{0, 0, 0};        ///< its edges, mm, where a header of text says them
};
/// @throws std::runtime_error if a file is not there, or as header_of_volume()
VolumeBytes bytes_of_volume(const std::string& path);

} // namespace springproof::cases
