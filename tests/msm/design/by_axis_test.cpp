#include "msm/design/by_axis.hpp"

#include "mechanics/dense.hpp"
#include "msm/design/cells.hpp"
#include "msm/design/design.hpp"
#include "msm/design/small_strain.hpp"
#include "tests/support/largest.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using namespace springproof;

using Eigen::Vector3d;
using mechanics::TransverseModuli;

/// Springs of cells that are no cubes. Designs that were looked through besides: `linear_method` fits one
/// stiffness a kind on any cell, and its misfit is told; `uniform` with a stiffness of its own and `given`
/// likewise; the published ones, the nonlinear method and the multi-load fit ask for cubes; `transverse` too;
/// cut cells follow their shape.
namespace {

msm::CellVertices box(const Vector3d& edges) {
  msm::CellVertices cell = msm::cube(1);
  for (Vector3d& x : cell) x = x.cwiseProduct(edges) + Vector3d(3, -1, 2);
  return cell;
}

msm::DesignResult designed(cases::Design design, const cases::Material& material, const Vector3d& edges) {
  msm::DesignRequest request;
  request.options.design = design;
  request.material = material;
  request.cell = box(edges);
  return msm::design(request);
}

bool are_all_stiff(const msm::CellTerms& cell) {
  return std::all_of(cell.springs.begin(), cell.springs.end(),
                     [](const msm::CellSpring& spring) { return spring.stiffness > 0; });
}

bool is_sound(const msm::CellTerms& cell, const msm::CellVertices& vertices) {
  const msm::Signs signs = msm::signs_at_rest(msm::cell_stiffness_matrix(vertices, cell));
  return signs.n_negative == 0 && signs.n_zero == 6;
}

} // namespace

TEST_CASE("in boxes whose edges differ by up to 1.65 the lattice has the material's moduli, with springs "
          "that pull all",
          "[verification]") {
  const Vector3d edges = GENERATE(Vector3d(1, 1, 1.5), Vector3d(1, 1, 1.65), Vector3d(0.4, 0.4, 0.25),
                                  Vector3d(1, 1.2, 1.5), Vector3d(2, 1.3, 1.9), Vector3d(1, 1, 1.001));
  for (const double nu : {0.1, 0.25, 0.35, 0.47})
    for (const cases::Design design : {cases::Design::hybrid, cases::Design::matched}) {
      const msm::DesignResult result = designed(design, cases::LinearElastic{0.005, nu}, edges);
      CAPTURE(edges.transpose(), nu, result.misfit->text);
      CHECK(result.misfit->largest < 1e-9); // closed forms; lambda/mu = 16 and flat cells cancel digits
      REQUIRE(result.springs.terms());
      CHECK(are_all_stiff(result.springs.terms()->kinds.front()));
      CHECK(is_sound(result.springs.terms()->kinds.front(), box(edges)));
      CHECK((result.springs.terms()->kinds.front().springs.front().law.kind == msm::LawKind::power_log) ==
            (design == cases::Design::matched));
    }
  const msm::DesignResult ogden =
      designed(cases::Design::hybrid, cases::Ogden{{0.04}, {2}, std::nullopt}, edges);
  CHECK(ogden.misfit->largest < 0.003); // lambda = 200 mu stands for incompressible
  const msm::DesignResult springs = designed(cases::Design::moduli, cases::LinearElastic{0.3, 0.25}, edges);
  CHECK(springs.misfit->largest < 1e-9); // springs alone have them at nu = 1/4
}

TEST_CASE("a box's free number is the split where springs allow it, and grows where they do not") {
  const msm::CubicModuli target{0.3, 0.1, 0.2};
  const auto part = [&](double split, const Vector3d& edges) {
    const auto found = msm::exact_by_axis(target, split, box(edges));
    REQUIRE(found);
    const double face = std::max({edges[0] * edges[1], edges[1] * edges[2], edges[0] * edges[2]});
    return 4 * found->springs[6] * face * face / (edges.squaredNorm() * edges.prod() * target.c44);
  };
  CHECK(part(0.3, {1, 1, 1.1}) == Approx(0.3));
  CHECK(part(0.8, {1, 1, 1.5}) == Approx(0.8));
  CHECK(part(0.3, {1, 1, 1.5}) ==
        Approx((0.05 + 2 * 1.5 * 1.5 - 3) / (1.5 * 1.5))); // edges along z carry 5 %
}

TEST_CASE(
    "in longer boxes the springs are the nearest, none of them without stiffness, and the misfit is told") {
  struct Row {
    Vector3d edges;
    double most; // what an independent least squares leaves of E, G and nu is 2 to 3 points less (numpy)
  };
  for (const Row& row : {Row{{1, 1, 2}, 0.36}, Row{{10, 10, 5}, 0.24}, Row{{1, 1, 1.8}, 0.2}})
    for (const double nu : {0.25, 0.35, 0.47})
      for (const cases::Design design : {cases::Design::hybrid, cases::Design::matched}) {
        const msm::DesignResult result = designed(design, cases::LinearElastic{0.3, nu}, row.edges);
        CAPTURE(row.edges.transpose(), nu, result.misfit->text);
        CHECK(result.misfit->largest > msm::told_moduli_misfit);
        CHECK(result.misfit->largest < row.most);
        CHECK(std::count(result.warnings.begin(), result.warnings.end(), result.misfit->text) == 1);
        REQUIRE(result.springs.terms());
        CHECK(are_all_stiff(result.springs.terms()->kinds.front()));
        CHECK(is_sound(result.springs.terms()->kinds.front(), box(row.edges)));
      }
}

TEST_CASE("a cell that is no box has springs by axis where four stiffnesses do not come near its material") {
  msm::DesignRequest request;
  request.options.design = cases::Design::hybrid;
  request.material = cases::LinearElastic{0.3, 0.3};
  request.cell = box({1, 1, 1.4});
  for (Vector3d& x : request.cell) x.x() += 0.05 * x.z(); // sheared
  const msm::DesignResult leaning = msm::design(request);
  REQUIRE(leaning.springs.terms());
  const double four =
      msm::moduli_misfit(
          msm::cell_elasticity(msm::hybrid_method(0.3 * 0.3 / (1.3 * 0.4), 0.3 / 2.6, 0.8, request.cell),
                               request.cell),
          *msm::elasticity_at_rest(request.material))
          .largest;
  CHECK(leaning.misfit->largest < 0.5 * four);
  request.cell = box({1, 1, 1});
  request.cell[7].x() += 0.01;
  CHECK(msm::design(request).springs.cells());
}

/// Springs of transversely isotropic materials.
namespace {

constexpr double cell_side = 1.3;

/// Moduli of a material that a lattice can have: C12 - C66 = C13 - C44.
constexpr TransverseModuli attainable{0.15, 0.09, 0.11, 0.4, 0.05, 0.03, 0};

cases::TransverselyIsotropic material_of(const TransverseModuli& moduli, cases::Axis fibre) {
  cases::TransverselyIsotropic material = mechanics::engineering_constants(moduli);
  material.fibre = Eigen::Vector3d::Unit(static_cast<int>(fibre));
  return material;
}

/// Muscle-like: no lattice has its moduli.
cases::TransverselyIsotropic muscle(const Eigen::Vector3d& fibre = Eigen::Vector3d::UnitZ()) {
  return {0.06, 0.02, 0.45, 0.7, 0.012, fibre};
}

msm::DesignRequest transverse_request(const cases::Material& material) {
  msm::DesignRequest request;
  request.material = material;
  request.cell = msm::cube(cell_side);
  request.options.design = cases::Design::transverse;
  return request;
}

/// Energy per volume of a strain, MPa.
double energy_density(const TransverseModuli& c, int fibre, const Eigen::Matrix3d& e) {
  const int i = (fibre + 1) % 3, j = (fibre + 2) % 3;
  const double e1 = e(i, i), e2 = e(j, j), e3 = e(fibre, fibre);
  return (c.c11 * (e1 * e1 + e2 * e2) + c.c33 * e3 * e3) / 2 + c.c12 * e1 * e2 + c.c13 * (e1 + e2) * e3 +
         2 * c.c44 * (e(fibre, i) * e(fibre, i) + e(fibre, j) * e(fibre, j)) + 2 * c.c66 * e(i, j) * e(i, j);
}

Eigen::Matrix3d any_strain(std::mt19937& generator) {
  std::uniform_real_distribution<double> any(-1, 1);
  Eigen::Matrix3d strain;
  for (double& entry : strain.reshaped()) entry = any(generator);
  return (strain + strain.transpose()) / 2;
}

} // namespace

TEST_CASE(
    "the periodic lattice of a transverse design has the material's moduli exactly, where a lattice can",
    "[verification]") {
  const cases::Axis fibre = GENERATE(cases::Axis::x, cases::Axis::y, cases::Axis::z);
  const double split = GENERATE(0., 0.8, 1.);
  msm::DesignRequest request = transverse_request(material_of(attainable, fibre));
  request.options.split = split;
  const msm::DesignResult design = msm::design(request);
  const std::string warnings = design.warnings.empty() ? "" : design.warnings.front();
  if (split < 1) CHECK(warnings.empty());
  if (split == 1) CHECK_THAT(warnings, Catch::Contains("mechanism")); // a kind of face diagonals is missing
  REQUIRE(design.by_fibre);
  CHECK(design.by_fibre->misfit <= 1e-12); // rounding error
  REQUIRE(design.springs.terms());

  // Cells of a body share springs: under an affine displacement it stores the lattice's energy, and its inner
  // points are in equilibrium.
  const cases::Mesh mesh = cases::make_box_mesh(Eigen::Vector3d::Constant(4 * cell_side), {4, 4, 4});
  const msm::Lattice lattice = msm::make_lattice(mesh, design.springs);
  const double volume = std::pow(4 * cell_side, 3);
  std::mt19937 generator(1);
  for (int trial = 0; trial < 10; ++trial) {
    const Eigen::Matrix3d strain = any_strain(generator);
    msm::Points motion = lattice.rest;
    for (Eigen::Vector3d& x : motion) x = strain * x;
    const double expected = volume * energy_density(attainable, static_cast<int>(fibre), strain);
    CAPTURE(cases::name_of(fibre), split);
    CHECK(std::abs(msm::small_motion_energy(lattice, motion) / expected - 1) <= 1e-12);
  }
  msm::Points deformed = lattice.rest;
  const Eigen::Matrix3d deformation = Eigen::Matrix3d::Identity() + 0.2 * any_strain(generator);
  for (Eigen::Vector3d& x : deformed) x = deformation * x;
  const msm::Points force = msm::internal_force(lattice, deformed);
  double largest = 0, inner = 0;
  for (std::size_t p = 0; p < force.size(); ++p) {
    const Eigen::Vector3d& x = lattice.rest[p];
    const bool is_inner = x.minCoeff() > 0.1 && x.maxCoeff() < 4 * cell_side - 0.1;
    (is_inner ? inner : largest) = larger(is_inner ? inner : largest, force[p].norm());
  }
  CHECK(inner <= 1e-13 * largest);
}

TEST_CASE("the transverse design of isotropic constants is the hybrid", "[verification]") {
  const double nu = 0.35, modulus = 0.3;
  const cases::TransverselyIsotropic material{
      modulus, modulus, nu, nu, modulus / (2 * (1 + nu)), Eigen::Vector3d::UnitY()};
  msm::DesignRequest isotropic = transverse_request(cases::LinearElastic{modulus, nu});
  isotropic.options.design = cases::Design::hybrid;
  const msm::CellTerms expected = msm::terms_of(msm::design(isotropic).stiffness),
                       found = msm::design(transverse_request(material)).springs.terms()->kinds.front();
  REQUIRE(found.springs.size() == expected.springs.size());
  for (std::size_t s = 0; s < found.springs.size(); ++s) {
    CHECK(found.springs[s].vertices == expected.springs[s].vertices);
    CHECK(found.springs[s].stiffness == Approx(expected.springs[s].stiffness).epsilon(1e-12));
  }
  CHECK(found.volume == Approx(expected.volume).epsilon(1e-12));
}

TEST_CASE("no moduli of a lattice are nearer to a material's than those of the transverse design",
          "[verification]") {
  const TransverseModuli wanted = mechanics::transverse_moduli(muscle());
  const msm::NearestModuli nearest = msm::nearest_lattice_moduli(wanted);
  const TransverseModuli& c = nearest.moduli;
  CHECK(std::abs(c.c12 - c.c66 - (c.c13 - c.c44)) <= 1e-15);
  // A sum over an orthonormal basis of the strains, orthogonal in the material's energy: by its eigenvectors.
  using Mandel = Eigen::Matrix<double, 6, 6>;
  const auto elasticity = [](const TransverseModuli& m) {
    Mandel result = Mandel::Zero();
    result.topLeftCorner<3, 3>() << m.c11, m.c12, m.c13, m.c12, m.c11, m.c13, m.c13, m.c13, m.c33;
    result.diagonal().tail<3>() << 2 * m.c44, 2 * m.c44, 2 * m.c66;
    return result;
  };
  const Mandel root = mechanics::inverse_square_root(elasticity(wanted));
  const auto distance = [&](const TransverseModuli& m) {
    return (root * (elasticity(m) - elasticity(wanted)) * root).norm();
  };
  CHECK(nearest.distance == Approx(distance(c)).epsilon(1e-9));
  std::mt19937 generator(2);
  std::uniform_real_distribution<double> any(-1, 1);
  for (int trial = 0; trial < 200; ++trial) { // all directions that a lattice can go
    const double size = 1e-4 * std::pow(10, 2 * any(generator));
    TransverseModuli other = c;
    for (double* of : {&other.c11, &other.c12, &other.c13, &other.c33, &other.c44})
      *of += size * any(generator);
    other.c66 = other.c12 - other.c13 + other.c44;
    CHECK(distance(other) >= nearest.distance);
  }
  // The misfit is the largest relative error of the energy of a strain: a bound, and reached.
  double largest = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    const Eigen::Matrix3d strain = any_strain(generator);
    largest = larger(largest, std::abs(energy_density(c, 2, strain) / energy_density(wanted, 2, strain) - 1));
  }
  CHECK(largest <= nearest.misfit * (1 + 1e-12));
  const Eigen::VectorXd ratios = mechanics::eigenvalues(root * elasticity(c) * root);
  CHECK(nearest.misfit == Approx(std::max(std::abs(ratios[0] - 1), std::abs(ratios[5] - 1))).epsilon(1e-9));
  CHECK(nearest.misfit > 0.05); // the test is of a material that lattices do not have
}

TEST_CASE("engineering constants and moduli are each other's inverse") {
  const cases::TransverselyIsotropic m = muscle(),
                                     back = mechanics::engineering_constants(mechanics::transverse_moduli(m));
  CHECK(back.youngs_modulus_along == Approx(m.youngs_modulus_along).epsilon(1e-12));
  CHECK(back.youngs_modulus_across == Approx(m.youngs_modulus_across).epsilon(1e-12));
  CHECK(back.poissons_ratio_along == Approx(m.poissons_ratio_along).epsilon(1e-12));
  CHECK(back.poissons_ratio_across == Approx(m.poissons_ratio_across).epsilon(1e-12));
  CHECK(back.shear_modulus_along == m.shear_modulus_along);
}

TEST_CASE("a lattice that is not the material's says by how much, and its cell is stable") {
  const msm::DesignResult design = msm::design(transverse_request(muscle()));
  REQUIRE(design.warnings.size() == 1);
  CHECK_THAT(design.warnings[0],
             Catch::Contains("C12 - C66 = C13 - C44") && Catch::Contains("err by up to 11 %"));
  REQUIRE(design.residual);
  CHECK(*design.residual == design.by_fibre->distance);
  const msm::CellMatrix tangent =
      msm::cell_stiffness_matrix(msm::cube(cell_side), design.springs.terms()->kinds.front());
  const Eigen::VectorXd eigenvalues = mechanics::eigenvalues(tangent);
  CHECK(largest_entry(eigenvalues.head<6>()) <= 1e-12 * eigenvalues[23]); // rigid motions
  CHECK(eigenvalues[6] > 1e-3 * eigenvalues[23]);
}

TEST_CASE("what the transverse design cannot serve is refused, and isotropic designs refuse its material") {
  const auto refused = [](const msm::DesignRequest& request, const std::string& why) {
    CHECK_THROWS_WITH(msm::design(request), Catch::Contains(why));
  };
  refused(transverse_request(muscle(Eigen::Vector3d(0, 3, 4) / 5)),
          "material.fibre is (0, 0.6, 0.8), must lie along an axis of the grid");
  refused(transverse_request(cases::LinearElastic{0.3, 0.35}), "with this isotropic material");
  // Ten times as stiff along the fibre, but eight times as stiff in shear along it
  refused(transverse_request(cases::TransverselyIsotropic{10, 1, 0.3, 0.3, 8, Eigen::Vector3d::UnitX()}),
          "the nearest ones err by 83.5 % in the energy of a strain");
  msm::DesignRequest brick = transverse_request(muscle());
  for (Eigen::Vector3d& vertex : brick.cell) vertex.z() *= 2;
  refused(brick, "cubical cells");
  const std::vector<cases::Design> own = msm::methods(muscle()),
                                   isotropic = msm::methods(cases::LinearElastic{});
  CHECK(own == std::vector<cases::Design>{cases::Design::midline, cases::Design::transverse});
  CHECK(std::count(isotropic.begin(), isotropic.end(), cases::Design::transverse) == 0);
  for (const cases::Design design : isotropic) {
    if (design == cases::Design::midline) continue; // is for both
    msm::DesignRequest request = transverse_request(muscle());
    request.options.design = design;
    refused(request, "must be \"midline\" | \"transverse\" | \"given\" | \"network\" with this transversely "
                     "isotropic material");
  }
}
