#include "msm/spring_body.hpp"

#include "msm/design/published.hpp"
#include "msm/tangent.hpp"
#include "tests/support/bodies.hpp"

#include <catch2/catch.hpp>
#include <map>

using namespace springproof;

using Eigen::Vector3d;

namespace {

msm::BodyTerms cut(const cases::Grid& grid, std::vector<msm::CellTerms> kinds) {
  msm::BodyTerms terms{std::move(kinds)};
  for (int k = 0; k < grid.cells[2]; ++k)
    for (int j = 0; j < grid.cells[1]; ++j)
      for (int i = 0; i < grid.cells[0]; ++i)
        if (grid.has(i, j, k)) terms.kind_of_cell.push_back((i + j + k) % 2);
  return terms;
}

/// Springs of a law, tetrahedra and a volume term.
msm::Lattice lattice_of_all_terms() {
  cases::Grid grid = bodies::masked_grid();
  std::vector<msm::CellTerms> kinds =
      msm::van_gelder(cases::cell_vertices(cases::make_grid_mesh(grid), 0), 0.3);
  const auto tetrahedra = msm::biquadratic(0.3, 0.1);
  for (std::size_t kind = 0; kind < 2; ++kind) {
    kinds[kind].tetrahedra = tetrahedra[kind].tetrahedra;
    kinds[kind].volume = 0.14;
    msm::set_exponents(kinds[kind], {-1.3, -2, 4.3});
  }
  return msm::make_lattice(cases::make_grid_mesh(grid), cut(grid, kinds));
}

} // namespace

TEST_CASE("springs that are whole at the boundary are all of the stiffness that they have inside") {
  const cases::HexMesh mesh =
      GENERATE(cases::make_box_mesh({3, 2, 2}, {{3, 2, 2}}), cases::make_grid_mesh(bodies::masked_grid()));
  const double k = 0.045;
  msm::BodyTerms terms{{msm::terms_of(msm::uniform_springs(k))}, {}, msm::Boundary::whole};
  const msm::Lattice whole = msm::make_lattice(mesh, terms);
  for (const msm::Link& link : whole.links)
    CHECK(link.spring.stiffness == Approx(k).epsilon(1e-14)); // a sum of at most four shares
  terms.boundary = msm::Boundary::shared;
  const msm::Lattice shared = msm::make_lattice(mesh, terms);
  REQUIRE(shared.links.size() == whole.links.size());
  const auto sum = [](const msm::Lattice& lattice) {
    double total = 0;
    for (const msm::Link& link : lattice.links) total += link.spring.stiffness;
    return total;
  };
  CHECK(sum(shared) < 0.8 * sum(whole)); // most springs of so small a body lie at its boundary
}

TEST_CASE("cells cut in mirror images agree on one diagonal of every face that they share") {
  cases::Grid grid;
  grid.cells = {3, 3, 2};
  const cases::HexMesh mesh = cases::make_grid_mesh(grid);
  const msm::Lattice lattice =
      msm::make_lattice(mesh, cut(grid, msm::van_gelder(cases::cell_vertices(mesh, 0), 0.3)));
  const std::size_t edges = 3 * 4 * 3 + 4 * 3 * 3 + 4 * 4 * 2, faces = 3 * 3 * 3 + 3 * 4 * 2 + 4 * 3 * 2;
  CHECK(lattice.links.size() == edges + faces);
  // Diagonals join the nodes of even i + j + k.
  for (const msm::Link& link : lattice.links) {
    if (link.spring.rest_length < 1.2) continue;
    const Vector3d at = lattice.rest[static_cast<std::size_t>(link.i)];
    CHECK(std::lround(at.sum()) % 2 == 0);
  }
}

TEST_CASE("the force of a lattice of any terms is minus the gradient of its energy, the tangent its slope") {
  const msm::Lattice lattice = lattice_of_all_terms();
  const msm::Points at = bodies::disturbed(lattice.rest, 0.1);
  const msm::Points force = msm::internal_force(lattice, at);
  Eigen::MatrixXd tangent = Eigen::MatrixXd::Zero(3 * static_cast<Eigen::Index>(at.size()),
                                                  3 * static_cast<Eigen::Index>(at.size()));
  msm::visit_tangent_blocks(lattice, at, msm::TransverseTerm::exact,
                            [&](int row, int column, const Eigen::Matrix3d& block) {
                              tangent.block<3, 3>(3 * row, 3 * column) += block;
                              if (row != column)
                                tangent.block<3, 3>(3 * column, 3 * row) += block.transpose();
                            });
  const double h = 1e-5; // mm
  for (std::size_t p = 0; p < at.size(); ++p)
    for (int a = 0; a < 3; ++a) {
      msm::Points before = at, after = at;
      before[p][a] -= h;
      after[p][a] += h;
      const double difference = (msm::energy(lattice, after) - msm::energy(lattice, before)) / (2 * h);
      CHECK(force[p][a] == Approx(-difference).margin(1e-8)); // h² times a third derivative of about 1
      const msm::Points low = msm::internal_force(lattice, before),
                        high = msm::internal_force(lattice, after);
      for (std::size_t q = 0; q < at.size(); ++q)
        for (int b = 0; b < 3; ++b)
          CHECK(tangent(3 * static_cast<Eigen::Index>(q) + b, 3 * static_cast<Eigen::Index>(p) + a) ==
                Approx((low[q][b] - high[q][b]) / (2 * h)).margin(1e-7));
    }
}

TEST_CASE("what a small motion of a lattice of any terms stores is half its quadratic form at rest") {
  const msm::Lattice lattice = lattice_of_all_terms();
  const double size = 1e-4; // mm; the energy's third order is 1e-4 of its second
  const msm::Points motion = bodies::disturbed(msm::Points(lattice.rest.size(), Vector3d::Zero()), size);
  CHECK(msm::small_motion_energy(lattice, motion) ==
        Approx(msm::energy_at(lattice, motion)).epsilon(20 * size));
}
