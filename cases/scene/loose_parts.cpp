#include "cases/scene/network.hpp"

#include <boost/pending/disjoint_sets.hpp>
#include <fmt/format.h>
#include <map>

namespace springproof::cases {

std::vector<std::string> loose_parts_of(const Scene& scene) {
  const std::size_t n_nodes = scene.mesh.nodes.size();
  boost::disjoint_sets_with_storage<> pieces(n_nodes);
  std::vector<bool> has_spring(n_nodes, false), is_held(n_nodes, false);
  for (const NetworkSpring& spring : scene.network) {
    has_spring[index(spring.a)] = has_spring[index(spring.b)] = true;
    pieces.union_set(index(spring.a), index(spring.b));
  }
  const std::vector<bool> is_constrained = constrained_dofs(scene);
  std::vector<bool> piece_is_held(n_nodes, false);
  for (std::size_t n = 0; n < n_nodes; ++n)
    for (std::size_t a = 0; a < 3; ++a)
      if (is_constrained[3 * n + a]) is_held[n] = piece_is_held[pieces.find_set(n)] = true;
  const auto first_of = [](const std::vector<std::size_t>& nodes) {
    constexpr std::size_t most = 5;
    return fmt::format("{}{}", fmt::join(nodes.data(), nodes.data() + std::min(most, nodes.size()), ", "),
                       nodes.size() > most ? ", ..." : "");
  };
  std::vector<std::size_t> alone;
  std::map<std::size_t, std::vector<std::size_t>> hanging; // by piece
  for (std::size_t n = 0; n < n_nodes; ++n) {
    if (!has_spring[n] && !is_held[n]) alone.push_back(n);
    if (has_spring[n] && !piece_is_held[pieces.find_set(n)]) hanging[pieces.find_set(n)].push_back(n);
  }
  std::vector<std::string> parts;
  if (!alone.empty())
    parts.push_back(fmt::format("{} of {} nodes have no spring and no support: {}", alone.size(), n_nodes,
                                first_of(alone)));
  for (const auto& [piece, nodes] : hanging) {
    constexpr std::size_t most = 5;
    if (parts.size() > most) {
      parts.push_back(fmt::format("{} pieces in all hang on nothing", hanging.size()));
      break;
    }
    parts.push_back(
        fmt::format("a piece of {} nodes and its springs hangs on nothing: no support acts on nodes {}",
                    nodes.size(), first_of(nodes)));
  }
  return parts;
}

} // namespace springproof::cases
