#include "msm/design/by_shape.hpp"

#include "msm/design/patch.hpp"
#include "msm/design/small_strain.hpp"
#include "msm/tangent.hpp"
#include "tests/support/bodies.hpp"
#include "tests/support/tetrahedra.hpp"

#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <cmath>

using namespace springproof;

using cases::index;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using msm::Points;

namespace {

const mechanics::ElasticModuli soft = mechanics::elastic_moduli(cases::LinearElastic{0.3, 0.4});

/// Cells of no regular shape; the middle nodes of a 3 x 3 x 3 box lie inside.
cases::Mesh disturbed_box(cases::CellShape shape) {
  cases::Mesh mesh = shape == cases::CellShape::tetrahedron ? bodies::box_of_tetrahedra({3, 3, 3})
                                                            : cases::make_box_mesh({3, 3, 3}, {3, 3, 3});
  mesh.nodes.stored() = bodies::disturbed(mesh.nodes.to_vector(), 0.15);
  mesh.grid.reset();
  return mesh;
}

msm::ShapeFit fit(const cases::Mesh& mesh) {
  return msm::fit_by_shape(mesh, {std::vector<mechanics::ElasticModuli>(mesh.cells.size(), soft), 0.8});
}

msm::SpringBody body_of(std::vector<msm::CellTerms> cells) {
  msm::BodyTerms body{std::move(cells)};
  for (std::size_t c = 0; c < body.kinds.size(); ++c) body.kind_of_cell.push_back(static_cast<int>(c));
  return body;
}

/// Where an affine motion moves points, of a strain that is no rotation.
Points affine(const Points& rest, double size) {
  Matrix3d gradient;
  gradient << 0.3, 0.2, -0.1, 0, -0.2, 0.4, 0.1, 0.05, 0.1;
  Points motion;
  for (const Vector3d& x : rest) motion.push_back(size * gradient * x);
  return motion;
}

} // namespace

TEST_CASE("springs of a cube alone are the hybrid's, and fit exactly", "[verification]") {
  const double edge = 1.7, split = GENERATE(0., 0.5, 0.8, 1.);
  const msm::CellVertices cube = msm::cube(edge);
  const msm::CellFit found = msm::fit_cell({cube.begin(), cube.end()}, soft, split);
  const msm::CellStiffness hybrid = msm::hybrid_method(soft.lambda, soft.mu, split, cube);
  const double rounding = 1e-12 * soft.mu * edge;
  CHECK(found.misfit < 1e-12);
  for (std::size_t s = 0; s < 28; ++s)
    CHECK(found.stiffness[s] == Approx(hybrid.springs()[s < 12 ? 0 : s < 24 ? 1 : 2]).margin(rounding));
}

TEST_CASE("springs of any cells have the bulk modulus, and none is negative") {
  const cases::Mesh mesh =
      disturbed_box(GENERATE(cases::CellShape::hexahedron, cases::CellShape::tetrahedron));
  const msm::ShapeFit found = fit(mesh);
  CHECK(found.over_the_mesh < found.cell_by_cell);
  CHECK(found.median_misfit <= found.worst_misfit);
  CHECK(found.n_loose_nodes == 0);
  double bulk = 0, volume = 0;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    const cases::CellCorners corners = cases::cell_corners(mesh, c);
    volume += cases::cell_volume(corners);
    bulk += found.cells[c].volume * cases::cell_volume(corners);
    for (const msm::CellSpring& spring : found.cells[c].springs) {
      CHECK(spring.stiffness >= 0);
      bulk += spring.stiffness / 9 *
              (corners[index(spring.vertices[1])] - corners[index(spring.vertices[0])]).squaredNorm();
    }
  }
  CHECK(bulk / volume == Approx(soft.kappa).epsilon(1e-12)); // rounding
}

TEST_CASE("springs of any hexahedra have the material's moduli in the mean over the mesh", "[verification]") {
  const cases::Mesh mesh = disturbed_box(cases::CellShape::hexahedron);
  const msm::ShapeFit found = fit(mesh);
  msm::Elasticity mean = msm::Elasticity::Zero();
  double volume = 0;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    const cases::CellCorners corners = cases::cell_corners(mesh, c);
    mean += cases::cell_volume(corners) * msm::cell_elasticity(found.cells[c], corners);
    volume += cases::cell_volume(corners);
  }
  const msm::Elasticity material = msm::elasticity_at_rest(cases::LinearElastic{0.3, 0.4}).value();
  // The descent ends where stiffnesses change by 1e-4 of the largest.
  CHECK((mean / volume - material).norm() < 2e-3 * material.norm());
}

TEST_CASE("flat cells have the material's moduli in the mean too, which their springs settle before",
          "[verification]") {
  cases::Mesh mesh = cases::make_box_mesh({3, 3, 1.8}, {3, 3, 3});
  mesh.grid.reset();
  const cases::LinearElastic material{0.3, 0.1};
  const msm::ShapeFit found = msm::fit_by_shape(
      mesh,
      {std::vector<mechanics::ElasticModuli>(mesh.cells.size(), mechanics::elastic_moduli(material)), 0.8});
  msm::Elasticity mean = msm::Elasticity::Zero(); // cells have one volume
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    mean += msm::cell_elasticity(found.cells[c], cases::cell_corners(mesh, c)) / double(mesh.cells.size());
  const msm::Elasticity wanted = msm::elasticity_at_rest(material).value();
  // The mean lacks at most 1e-3 of the energies; the end of the stiffnesses alone left 1.6e-3.
  CHECK((mean - wanted).norm() < 1e-3 * wanted.norm());
}

TEST_CASE("hexahedra whose springs cannot have the material's moduli get the least squares alone") {
  cases::Mesh mesh = disturbed_box(cases::CellShape::hexahedron);
  for (Vector3d& x : mesh.nodes.stored()) x = {x.x() + 0.5 * x.y(), x.y(), 0.1 * x.z()};
  const msm::ShapeFit found = fit(mesh);
  CHECK(found.over_the_mesh < found.cell_by_cell); // exact moduli would take more than the cells' own springs
  CHECK(found.n_loose_nodes == 0);
}

TEST_CASE("half a body on a plane of symmetry gets the springs of the whole") {
  const auto shape = GENERATE(cases::CellShape::hexahedron, cases::CellShape::tetrahedron);
  cases::Mesh half = shape == cases::CellShape::tetrahedron ? bodies::box_of_tetrahedra({2, 2, 2})
                                                            : cases::make_box_mesh({2, 2, 2}, {2, 2, 2});
  half.grid.reset();
  msm::FitRequest request{std::vector<mechanics::ElasticModuli>(half.cells.size(), soft), 0.8};
  const Points moved = bodies::disturbed(half.nodes.to_vector(), 0.1);
  const int n_nodes = static_cast<int>(moved.size()), across = 2; // the plane z = 0
  std::vector<int> image;                                         // one per node of the half
  cases::Mesh whole = half;
  for (int n = 0; n < n_nodes; ++n) {
    const bool is_on_plane = half.nodes[index(n)][across] < 1e-9;
    Vector3d x = moved[index(n)];
    if (is_on_plane) x[across] = 0, request.axes_of_node[n] = 1 << across;
    half.nodes.stored()[index(n)] = whole.nodes.stored()[index(n)] = x;
    image.push_back(is_on_plane ? n : static_cast<int>(whole.nodes.size()));
    x[across] = -x[across];
    if (!is_on_plane) whole.nodes.stored().push_back(x);
  }
  const std::size_t n_cells = half.cells.size();
  for (std::size_t c = 0; c < n_cells; ++c) { // the mirror's vertices in an order of positive volume
    const cases::CellNodes cell = half.cells[c];
    cases::CellNodes mirrored = cell;
    for (std::size_t v = 0; v < cell.size(); ++v)
      mirrored[v] = image[index(cell[cell.size() == 8 ? v ^ 4U : v == 2 ? 3 : v == 3 ? 2 : v])];
    whole.cells.stored().push_back(mirrored);
  }
  const msm::ShapeFit of_half = msm::fit_by_shape(half, request);
  const msm::ShapeFit of_whole =
      msm::fit_by_shape(whole, {std::vector<mechanics::ElasticModuli>(2 * n_cells, soft), 0.8});
  // Both descents end where stiffnesses change by 1e-4 of the largest, each with an order of its own.
  CHECK(of_half.over_the_mesh == Approx(of_whole.over_the_mesh).epsilon(1e-3));
  double largest = 0;
  for (const msm::CellSpring& spring : of_whole.cells[0].springs)
    largest = std::max(largest, spring.stiffness);
  if (shape == cases::CellShape::hexahedron) return; // a hexahedron has more springs than constants
  CHECK(of_half.cell_by_cell == Approx(of_whole.cell_by_cell).epsilon(1e-3));
  for (std::size_t c = 0; c < n_cells; ++c)
    for (std::size_t s = 0; s < of_half.cells[c].springs.size(); ++s)
      CHECK(of_half.cells[c].springs[s].stiffness ==
            Approx(of_whole.cells[c].springs[s].stiffness).margin(0.01 * largest));
}

// Edges along the six (1, +-1, 0)/sqrt(2), s = k l²/V: C11 = s, C12 = C44 = s/2. Parts of the material's
// energies that are missed: (s/2 - 2 mu)/(2 mu) twice, (s - 2 mu)/(2 mu) thrice, (2 s - 5 mu)/(3 K) once.
TEST_CASE("edges of a regular tetrahedron have the closed form of the least squares", "[verification]") {
  const cases::CellCorners regular{Vector3d(1, 1, 1), Vector3d(-1, -1, 1), Vector3d(-1, 1, -1),
                                   Vector3d(1, -1, -1)};
  const double mu = soft.mu, kappa = soft.kappa;
  const double s = (4 / mu + 20 * mu / (9 * kappa * kappa)) / (7 / (4 * mu * mu) + 8 / (9 * kappa * kappa));
  const double squares = 2 * std::pow((s / 2 - 2 * mu) / (2 * mu), 2) +
                         3 * std::pow((s - 2 * mu) / (2 * mu), 2) +
                         std::pow((2 * s - 5 * mu) / (3 * kappa), 2);
  const msm::CellFit found = msm::fit_cell(regular, soft, 0.8);
  for (const double k : found.stiffness) // the descent ends at changes of 1e-4
    CHECK(k == Approx(s * cases::cell_volume(regular) / 8).epsilon(1e-3));
  CHECK(found.misfit == Approx(std::sqrt(squares / 6)).epsilon(1e-6)); // quadratic in that
}

TEST_CASE("biquadratic springs pass the patch test on any tetrahedra", "[verification]") {
  const cases::Mesh mesh = disturbed_box(cases::CellShape::tetrahedron);
  const cases::LinearElastic material{0.3, 0.4};
  std::vector<msm::CellTerms> cells;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    const cases::CellCorners x = cases::cell_corners(mesh, c);
    cells.push_back(msm::in_tetrahedron(cases::Design::biquadratic, {x[0], x[1], x[2], x[3]}, material));
  }
  const msm::Lattice lattice = msm::make_lattice(mesh, body_of(cells));
  const Points motion = affine(lattice.rest, 0.3);
  const Points force = msm::internal_force_at(lattice, motion);
  int n_inside = 0;
  double largest = 0;
  for (const Vector3d& f : force) largest = std::max(largest, f.norm());
  const cases::Mesh box = cases::make_box_mesh({3, 3, 3}, {3, 3, 3});
  for (std::size_t n = 0; n < force.size(); ++n) {
    const Vector3d at = box.nodes[n]; // the tetrahedra have the box's nodes
    if (!(at.minCoeff() > 0.5 && at.maxCoeff() < 2.5)) continue;
    ++n_inside;
    CHECK(force[n].norm() < 1e-12 * largest);
  }
  CHECK(n_inside == 8);
  const Matrix3d f = [&] {
    Matrix3d columns, moved;
    for (int a = 0; a < 3; ++a) {
      columns.col(a) = lattice.rest[index(a) + 1] - lattice.rest[0];
      moved.col(a) = columns.col(a) + motion[index(a) + 1] - motion[0];
    }
    return Matrix3d(moved * columns.inverse());
  }();
  const Matrix3d green = 0.5 * (f.transpose() * f - Matrix3d::Identity());
  double volume = 0;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    volume += cases::cell_volume(cases::cell_corners(mesh, c));
  const double exact =
      volume * (soft.mu * green.squaredNorm() + soft.lambda / 2 * green.trace() * green.trace());
  CHECK(msm::energy_at(lattice, motion) == Approx(exact).epsilon(1e-12)); // St. Venant-Kirchhoff
}

TEST_CASE("volume terms at nodes have the volume, and derivatives that differences give", "[verification]") {
  const cases::Mesh mesh = disturbed_box(cases::CellShape::tetrahedron);
  msm::CellTerms cell;
  cell.volume = 0.7;
  cell.is_at_nodes = true;
  cell.is_logarithmic = GENERATE(false, true);
  const msm::Lattice lattice = msm::make_lattice(mesh, body_of(std::vector(mesh.cells.size(), cell)));
  REQUIRE(lattice.volume_patches.size() == mesh.nodes.size());
  CHECK(lattice.volume_cells.empty());
  double sum = 0, volume = 0;
  for (const msm::VolumePatch& patch : lattice.volume_patches) {
    CHECK(patch.stiffness == Approx(cell.volume).epsilon(1e-14)); // a mean of equal ones
    sum += patch.rest_volume;
  }
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    volume += cases::cell_volume(cases::cell_corners(mesh, c));
  CHECK(sum == Approx(volume).epsilon(1e-13));

  const Points at = [&] {
    Points x = lattice.rest;
    const Points motion = affine(x, 0.3);
    for (std::size_t n = 0; n < x.size(); ++n) x[n] += motion[n];
    return bodies::disturbed(x, 0.05);
  }();
  const double step = 1e-5; // the differences err by 1e-10, and by rounding of 1e-11
  const msm::VolumePatch& patch = lattice.volume_patches[21];
  const Points x = msm::at_nodes(patch.nodes, at), forces = patch.forces(x);
  const Eigen::MatrixXd tangent = patch.tangent_matrix(x, msm::Clamp::no);
  for (std::size_t v = 0; v < x.size(); ++v)
    for (int a = 0; a < 3; ++a) {
      Points before = x, after = x;
      before[v][a] -= step;
      after[v][a] += step;
      CHECK((patch.energy(before) - patch.energy(after)) / (2 * step) == Approx(forces[v][a]).margin(1e-7));
      const Points less = patch.forces(before), more = patch.forces(after);
      for (std::size_t w = 0; w < x.size(); ++w)
        CHECK(((less[w] - more[w]) / (2 * step) -
               tangent.block<3, 1>(3 * Eigen::Index(w), 3 * Eigen::Index(v) + a))
                  .norm() < 1e-7);
    }
  const Points rest = msm::at_nodes(patch.nodes, lattice.rest);
  Points motion = x;
  for (std::size_t v = 0; v < x.size(); ++v) motion[v] -= rest[v];
  CHECK(patch.law_at(rest, motion).pressure == Approx(patch.law(x).pressure).epsilon(1e-11));
}

TEST_CASE("uniform springs of tetrahedra have one stiffness and Van Gelder's sum of k l²") {
  const cases::Mesh mesh = disturbed_box(cases::CellShape::tetrahedron);
  const std::vector<double> youngs_modulus(mesh.cells.size(), 0.3);
  const msm::Lattice lattice = msm::make_lattice(mesh, body_of(msm::uniform_by_shape(mesh, youngs_modulus)));
  double sum = 0, volume = 0;
  for (const msm::Link& link : lattice.links) {
    CHECK(link.spring.stiffness == Approx(lattice.links[0].spring.stiffness).epsilon(1e-13));
    sum += link.spring.stiffness * link.spring.rest_length * link.spring.rest_length;
  }
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    volume += cases::cell_volume(cases::cell_corners(mesh, c));
  CHECK(sum == Approx(6 * 0.3 * volume).epsilon(1e-12));
}
