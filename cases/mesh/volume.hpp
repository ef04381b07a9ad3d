#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace springproof::cases {

/// Intensities of a picture in three dimensions. Voxel (i, j, k) reaches from (i, j, k) * spacing to
/// (i + 1, j + 1, k + 1) * spacing: where a file places or turns its array in a scanner is left out.
struct Volume {
  std::array<int, 3> voxels{};      ///< along x, y, z, > 0
  Eigen::Vector3d spacing{1, 1, 1}; ///< mm, > 0
  std::vector<float> intensities;   ///< x fastest
};

/// What a picture's file can hold.
struct VolumeBytes {
  std::uint64_t in_file;
  std::uint64_t of_voxels; ///< deflate makes at most 1032 bytes from one
  bool is_compressed;      ///< by gzip, from the first byte on
};

/// @throws std::runtime_error if it is no regular file
VolumeBytes bytes_of_volume(const std::string& path);

/// @param most_bytes  most bytes of voxels that the file can hold
/// @throws std::runtime_error unless there are voxels of a finite size above 0, no more than the file can
/// hold, and so few that they can be numbered
/// @return how many there are
std::size_t checked_voxels(const std::array<int, 3>& voxels, const Eigen::Vector3d& spacing,
                           std::size_t bytes_a_voxel, std::uint64_t most_bytes);

/// Inflates a gzipped file piece by piece, and keeps none: readers believe bytes that a checksum refutes, and
/// what has no end.
/// @param least, most  how many bytes it may hold
/// @throws std::runtime_error unless it is whole, its checksums right, and holds as many
void check_gzip(const std::string& path, std::uint64_t least, std::uint64_t most);

} // namespace springproof::cases
