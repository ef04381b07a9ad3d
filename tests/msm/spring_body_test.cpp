#include "msm/spring_body.hpp"

#include "msm/design/small_strain.hpp"
#include "tests/support/bodies.hpp"

#include <catch2/catch.hpp>

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

} // namespace

TEST_CASE("springs that are whole at the boundary are all of the stiffness that they have inside") {
  const cases::Mesh mesh =
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
  const cases::Mesh mesh = cases::make_grid_mesh(grid);
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
