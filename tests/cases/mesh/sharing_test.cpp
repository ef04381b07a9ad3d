#include "cases/mesh/sharing.hpp"

#include <catch2/catch.hpp>

using namespace springproof;

using namespace cases;

TEST_CASE("every node and every cell is one rank's, and a rank has the vertices of its cells") {
  Grid holes{{5, 4, 7}, {1, 1, 1}, {0, 0, 0}, {}};
  for (std::size_t c = 0; c < holes.n_lattice_cells(); ++c) holes.present.push_back(c % 5 != 2);
  for (const Mesh& mesh : {make_box_mesh({5, 4, 7}, {5, 4, 7}), make_grid_mesh(holes),
                           refine(make_box_mesh({1, 2, 3}, {1, 2, 3}))})
    for (const int n_ranks : {1, 2, 3, 8, 500}) { // there are fewer cells than 500
      Range last_nodes, last_cells;
      for (int rank = 0; rank < n_ranks; ++rank) {
        const Share share = share_of(mesh, rank, n_ranks);
        CHECK(share.own_nodes.begin == last_nodes.end);
        CHECK(share.cells.begin == last_cells.end);
        CHECK(share.nodes.common(share.own_nodes).size() == share.own_nodes.size());
        for (std::size_t c = share.cells.begin; c < share.cells.end; ++c)
          for (const int vertex : mesh.cells[c]) CHECK(share.nodes.has(index(vertex)));
        last_nodes = share.own_nodes;
        last_cells = share.cells;
      }
      CHECK(last_nodes.end == mesh.nodes.size());
      CHECK(last_cells.end == mesh.cells.size());
    }
}

TEST_CASE("a rank's share of a box is a slab with a plane of its neighbours'") {
  const Mesh mesh = make_box_mesh({20, 20, 40}, {20, 20, 40});
  for (int rank = 0; rank < 4; ++rank) {
    const Share share = share_of(mesh, rank, 4);
    CHECK(share.nodes.size() <= share.own_nodes.size() + 21 * 21 + 2 * 22); // and where rows begin and end
  }
}
