#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace springproof::cases {

/// Intensities of a picture in three dimensions. Voxel (i, j, k) reaches from (i, j, k) * spacing to
/// (i + 1, j + 1, k + 1) * spacing: where a file places or turns its array in a scanner is left out.
struct Volume {
  std::array<int, 3> voxels{};      ///< along x, y, z, > 0
  Eigen::Vector3d spacing{1, 1, 1}; ///< mm, > 0
  std::vector<float> intensities;   ///< x fastest
};

/// @param most_bytes  of voxels that the file can hold
/// @throws std::runtime_error unless there are voxels of a finite size above 0, no more than the file can
/// hold, and so few that they can be numbered
/// @return how many there are
std::size_t checked_voxels(const std::array<int, 3>& voxels, const Eigen::Vector3d& spacing,
                           std::size_t bytes_a_voxel, std::uint64_t most_bytes);

} // namespace springproof::cases
