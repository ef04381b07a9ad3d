#include "msm/design/by_axis.hpp"

#include "msm/design/design.hpp"
#include "msm/design/examine.hpp"
#include "msm/design/moduli_method.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

using namespace springproof;

using Eigen::Vector3d;

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
  CHECK(springs.misfit->largest < 1e-9); // at nu = 1/4 springs alone have them
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
