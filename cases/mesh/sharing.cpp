#include "cases/mesh/sharing.hpp"

namespace springproof::cases {

Share share_of(const HexMesh& mesh, int rank, int n_ranks) {
  Share share{part_of(mesh.nodes.size(), rank, n_ranks), part_of(mesh.cells.size(), rank, n_ranks), {}};
  share.nodes = share.own_nodes;
  for (std::size_t c = share.cells.begin; c < share.cells.end; ++c)
    for (const int vertex : mesh.cells[c]) {
      share.nodes.begin = std::min(share.nodes.begin, index(vertex));
      share.nodes.end = std::max(share.nodes.end, index(vertex) + 1);
    }
  return share;
}

} // namespace springproof::cases
