#include "msm/design/published.hpp"

#include <cmath>

namespace springproof::msm {

namespace {

TetrahedronPositions pick_positions(const CellPositions& cell, const std::array<int, 4>& vertices) {
  TetrahedronPositions x;
  for (std::size_t v = 0; v < 4; ++v) x[v] = cell[cases::index(vertices[v])];
  return x;
}

/// Adds a stiffness to the spring between two vertices.
void add_spring(CellTerms& terms, int v, int w, double stiffness) {
  const std::array<int, 2> vertices{std::min(v, w), std::max(v, w)};
  for (CellSpring& spring : terms.springs)
    if (spring.vertices == vertices) {
      spring.stiffness += stiffness;
      return;
    }
  terms.springs.push_back({vertices, stiffness});
}

/// Both kinds, with the springs of every tetrahedron's edges.
/// @param stiffness  returns an edge's, N/mm, from the tetrahedron's volume (mm³) and the edge's length (mm)
template<class Stiffness>
std::vector<CellTerms> springs_of_tetrahedra(const CellPositions& cell, const Stiffness& stiffness) {
  std::vector<CellTerms> kinds(2);
  for (int kind = 0; kind < 2; ++kind)
    for (const std::array<int, 4>& vertices : five_tetrahedra(kind)) {
      const TetrahedronPositions x = pick_positions(cell, vertices);
      const double volume = tetrahedron_volume(x);
      for (const auto& [a, b] : tetrahedron_edges)
        add_spring(kinds[cases::index(kind)], vertices[cases::index(a)], vertices[cases::index(b)],
                   stiffness(volume, (x[cases::index(b)] - x[cases::index(a)]).norm()));
    }
  return kinds;
}

} // namespace

CellStiffness ladd_kinney(double youngs_modulus, double edge) {
  const double k = 2 * youngs_modulus * edge / 5;
  return {k / 4, k / 2, 0, 0};
}

CellStiffness baudet(double youngs_modulus, double poissons_ratio, double edge) {
  const double unit = youngs_modulus * edge / (8 * (1 + poissons_ratio));
  return {(4 * poissons_ratio + 1) * unit, 0, 3 * unit, 0};
}

CellStiffness uniform_springs(double stiffness) {
  return {stiffness / 4, stiffness / 2, stiffness, 0};
}

double uniform_stiffness(double youngs_modulus, double edge) {
  return youngs_modulus * edge / 2.7;
}

std::array<std::array<int, 4>, 5> five_tetrahedra(int kind) {
  // The mirror image in x exchanges vertices v and v ^ 1; two of them exchanged keep the volumes positive.
  std::array<std::array<int, 4>, 5> tetrahedra{
      {{1, 0, 5, 3}, {2, 0, 3, 6}, {4, 0, 6, 5}, {7, 3, 5, 6}, {0, 3, 6, 5}}};
  if (kind == 1)
    for (auto& tetrahedron : tetrahedra) {
      for (int& vertex : tetrahedron) vertex ^= 1;
      std::swap(tetrahedron[2], tetrahedron[3]);
    }
  return tetrahedra;
}

std::vector<CellTerms> van_gelder(const CellPositions& vertices, double youngs_modulus) {
  return springs_of_tetrahedra(
      vertices, [&](double volume, double length) { return youngs_modulus * volume / (length * length); });
}

std::vector<CellTerms> lloyd(const CellPositions& vertices, double youngs_modulus) {
  return springs_of_tetrahedra(vertices, [&](double volume, double) {
    return 2 * std::sqrt(2.) / 25 * youngs_modulus * std::cbrt(12 * volume / std::sqrt(2.));
  });
}

std::vector<CellTerms> biquadratic(double lambda, double mu) {
  std::vector<CellTerms> kinds(2);
  for (int kind = 0; kind < 2; ++kind)
    for (const std::array<int, 4>& vertices : five_tetrahedra(kind))
      kinds[cases::index(kind)].tetrahedra.push_back({vertices, lambda, mu});
  return kinds;
}

} // namespace springproof::msm
