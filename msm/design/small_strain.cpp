#include "msm/design/small_strain.hpp"

#include "cases/case/error.hpp"
#include "mechanics/elastic_moduli.hpp"
#include "msm/design/minimise.hpp"

#include <algorithm>
#include <cmath>

namespace springproof::msm {

cases::LinearElastic small_strain_material(const cases::Material& material) {
  if (const auto* linear = std::get_if<cases::LinearElastic>(&material)) return *linear;
  if (std::holds_alternative<cases::TransverselyIsotropic>(material))
    throw cases::InputError(
        "material.model: is \"transversely_isotropic\", and an isotropic material is wanted here");
  const cases::HyperelasticRest rest = cases::hyperelastic_rest(material).value();
  if (!rest.bulk_modulus) return {3 * rest.shear_modulus, 0.5};
  return mechanics::linear_elastic(rest.shear_modulus, *rest.bulk_modulus);
}

std::optional<Elasticity> elasticity_at_rest(const cases::Material& material) {
  Elasticity c = Elasticity::Zero();
  if (const auto* fibrous = std::get_if<cases::TransverselyIsotropic>(&material)) {
    const auto axis = cases::axis_along(fibrous->fibre);
    if (!axis) return std::nullopt;
    const mechanics::TransverseModuli m = mechanics::transverse_moduli(*fibrous);
    const int fibre = static_cast<int>(*axis);
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) c(i, j) = i == fibre || j == fibre ? m.c13 : m.c12;
      c(i, i) = i == fibre ? m.c33 : m.c11;
      c(3 + i, 3 + i) = i == fibre ? m.c66 : m.c44;
    }
    return c;
  }
  cases::LinearElastic linear = small_strain_material(material);
  if (!(linear.youngs_modulus > 0)) return std::nullopt;
  // Incompressible is a Poisson's ratio of 0.5 but for what no constant of the comparison shows.
  linear.poissons_ratio = std::min(linear.poissons_ratio, 0.5 - 1e-6);
  const mechanics::ElasticModuli moduli = mechanics::elastic_moduli(linear);
  c.topLeftCorner<3, 3>().setConstant(moduli.lambda);
  c.diagonal() << Eigen::Vector3d::Constant(moduli.lambda + 2 * moduli.mu),
      Eigen::Vector3d::Constant(moduli.mu);
  return c;
}

LinearFit linear_method(const CellMatrix& reference, const CellVertices& vertices) {
  Eigen::MatrixXd unit(576, 3);
  const std::array<CellStiffness, 3> units = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
  for (int c = 0; c < 3; ++c)
    unit.col(c) = cell_stiffness_matrix(vertices, units[static_cast<std::size_t>(c)]).reshaped();
  const Eigen::Vector3d k = nonnegative_least_squares(unit, reference.reshaped());
  return {{k(0), k(1), k(2), 0}, (reference.reshaped() - unit * k).norm()};
}

namespace {

/// Springs nearest to the cubic elasticity with C12 = C44.
CellStiffness nearest_springs(double c11, double c44, double split, const CellVertices& vertices) {
  Elasticity target = Elasticity::Zero();
  target.topLeftCorner<3, 3>().setConstant(c44);
  target.diagonal() << Eigen::Vector3d::Constant(c11), Eigen::Vector3d::Constant(c44);
  const CellStiffness unit_shear = {0, (1 - split) / 2, 0.75 * split, 0};
  Eigen::MatrixXd unit(36, 2);
  unit.col(0) = cell_elasticity({1, 0, 0, 0}, vertices).reshaped();
  unit.col(1) = cell_elasticity(unit_shear, vertices).reshaped();
  const Eigen::VectorXd k = nonnegative_least_squares(unit, target.reshaped());
  return {k(0), k(1) * unit_shear.face_diagonal, k(1) * unit_shear.internal_diagonal, 0};
}

} // namespace

double c11_of_springs(double youngs_modulus, double shear_modulus) {
  const double difference = youngs_modulus - shear_modulus, sum = youngs_modulus + shear_modulus;
  return (difference + std::sqrt(sum * sum + 8 * shear_modulus * shear_modulus)) / 2;
}

CellStiffness moduli_method(double youngs_modulus, double shear_modulus, double split,
                            const CellVertices& vertices) {
  return nearest_springs(c11_of_springs(youngs_modulus, shear_modulus), shear_modulus, split, vertices);
}

CellStiffness hybrid_method(double lame_lambda, double lame_mu, double split, const CellVertices& vertices) {
  CellStiffness stiffness = nearest_springs(3 * lame_mu, lame_mu, split, vertices);
  stiffness.volume = lame_lambda - lame_mu;
  return stiffness;
}

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
      const double volume = volume_of(x);
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

namespace {

double van_gelder_stiffness(double youngs_modulus, double volume, double length) {
  return youngs_modulus * volume / (length * length);
}

double lloyd_stiffness(double youngs_modulus, double volume) {
  return 2 * std::sqrt(2.) / 25 * youngs_modulus * std::cbrt(12 * volume / std::sqrt(2.));
}

} // namespace

std::vector<CellTerms> van_gelder(const CellPositions& vertices, double youngs_modulus) {
  return springs_of_tetrahedra(vertices, [&](double volume, double length) {
    return van_gelder_stiffness(youngs_modulus, volume, length);
  });
}

std::vector<CellTerms> lloyd(const CellPositions& vertices, double youngs_modulus) {
  return springs_of_tetrahedra(
      vertices, [&](double volume, double) { return lloyd_stiffness(youngs_modulus, volume); });
}

CellTerms in_tetrahedron(cases::Design design, const TetrahedronPositions& x,
                         const cases::LinearElastic& material) {
  if (design == cases::Design::biquadratic) {
    const mechanics::ElasticModuli moduli = mechanics::elastic_moduli(material);
    return {{}, {{{0, 1, 2, 3}, moduli.lambda, moduli.mu}}};
  }
  const double volume = volume_of(x), e = material.youngs_modulus;
  CellTerms terms;
  for (const auto& [a, b] : tetrahedron_edges)
    add_spring(terms, a, b,
               design == cases::Design::lloyd
                   ? lloyd_stiffness(e, volume)
                   : van_gelder_stiffness(e, volume, (x[cases::index(b)] - x[cases::index(a)]).norm()));
  return terms;
}

std::vector<CellTerms> biquadratic(double lambda, double mu) {
  std::vector<CellTerms> kinds(2);
  for (int kind = 0; kind < 2; ++kind)
    for (const std::array<int, 4>& vertices : five_tetrahedra(kind))
      kinds[cases::index(kind)].tetrahedra.push_back({vertices, lambda, mu});
  return kinds;
}

} // namespace springproof::msm
