#include "compare/sweep/box_interpolation.hpp"

#include <algorithm>
#include <cassert>

namespace springproof::compare {

namespace {

/// Where a node of one grid lies between two of another, along one axis.
struct Place {
  std::size_t lower;
  double weight_of_upper; ///< 0 to 1
};

/// In whole numbers, so that nodes which coincide do so exactly.
std::vector<Place> places(int from, int to) {
  std::vector<Place> all;
  for (int i = 0; i <= to; ++i) {
    const int lower = std::min(i * from / to, from - 1);
    all.push_back({static_cast<std::size_t>(lower), static_cast<double>(i * from - lower * to) / to});
  }
  return all;
}

} // namespace

std::vector<Eigen::Vector3d> interpolate(const std::vector<Eigen::Vector3d>& field,
                                         const std::array<int, 3>& from, const std::array<int, 3>& to) {
  const auto n_x = static_cast<std::size_t>(from[0] + 1), n_y = static_cast<std::size_t>(from[1] + 1);
  assert(field.size() == n_x * n_y * static_cast<std::size_t>(from[2] + 1));
  std::vector<Eigen::Vector3d> result;
  for (const Place& z : places(from[2], to[2]))
    for (const Place& y : places(from[1], to[1]))
      for (const Place& x : places(from[0], to[0])) {
        Eigen::Vector3d value = Eigen::Vector3d::Zero();
        for (std::size_t corner = 0; corner < 8; ++corner) {
          const std::size_t i = corner & 1, j = corner >> 1 & 1, k = corner >> 2;
          const double weight = (i ? x.weight_of_upper : 1 - x.weight_of_upper) *
                                (j ? y.weight_of_upper : 1 - y.weight_of_upper) *
                                (k ? z.weight_of_upper : 1 - z.weight_of_upper);
          value += weight * field[(z.lower + k) * n_x * n_y + (y.lower + j) * n_x + x.lower + i];
        }
        result.push_back(value);
      }
  return result;
}

} // namespace springproof::compare
