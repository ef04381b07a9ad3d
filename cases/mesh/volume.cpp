#include "cases/mesh/volume.hpp"

#include <limits>
#include <stdexcept>
#include <string>

namespace springproof::cases {

std::size_t checked_voxels(const std::array<int, 3>& voxels, const Eigen::Vector3d& spacing,
                           std::size_t bytes_a_voxel, std::uint64_t most_bytes) {
  const std::string size =
      std::to_string(voxels[0]) + " x " + std::to_string(voxels[1]) + " x " + std::to_string(voxels[2]);
  double n = 1;
  for (std::size_t a = 0; a < 3; ++a) {
    if (voxels[a] < 1) throw std::runtime_error("has " + size + " voxels, must have some in every direction");
    n *= voxels[a];
    const double length = spacing[static_cast<int>(a)];
    if (!(length > 1e-6 && length < 1e6))
      throw std::runtime_error("has voxels of " + std::to_string(length) +
                               " mm, must be from 1e-6 to 1e6 mm");
  }
  if (!(n * static_cast<double>(bytes_a_voxel) <= static_cast<double>(most_bytes)))
    throw std::runtime_error("says that it has " + size + " voxels, more than the file can hold");
  if (!(n <= std::numeric_limits<int>::max()))
    throw std::runtime_error("has " + size + " voxels, must have fewer than 2^31");
  return static_cast<std::size_t>(n);
}

} // namespace springproof::cases
