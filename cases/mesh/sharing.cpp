#include "cases/mesh/sharing.hpp"

namespace springproof::cases {

Share share_of(const HexMesh& mesh, int rank, int n_ranks) {
  Share share{part_of(mesh.nodes.size(), rank, n_ranks), part_of(mesh.cells.size(), rank, n_ranks), {}};
  const Range vertices = vertices_of(mesh, share.cells);
  share.nodes = share.own_nodes;
  if (vertices.size() > 0)
    share.nodes = {std::min(share.own_nodes.begin, vertices.begin),
                   std::max(share.own_nodes.end, vertices.end)};
  return share;
}

Range vertices_of(const HexMesh& mesh, const Range& cells) {
  if (cells.size() == 0) return {};
  Range nodes{mesh.nodes.size(), 0};
  for (std::size_t c = cells.begin; c < cells.end; ++c)
    for (const int vertex : mesh.cells[c]) {
      nodes.begin = std::min(nodes.begin, index(vertex));
      nodes.end = std::max(nodes.end, index(vertex) + 1);
    }
  return nodes;
}

} // namespace springproof::cases
