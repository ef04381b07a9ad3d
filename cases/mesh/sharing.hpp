#pragma once

#include "cases/mesh/mesh.hpp"

#include <cstdint>

/// Answers that several ranks have together.
namespace springproof::cases {

/// Numbers of nodes or of cells: begin to end - 1.
struct Range {
  std::size_t begin = 0, end = 0;
  std::size_t size() const { return end - begin; }
  bool has(std::size_t number) const { return number >= begin && number < end; }
  Range common(const Range& other) const {
    const std::size_t first = std::max(begin, other.begin);
    return {first, std::max(first, std::min(end, other.end))};
  }
};

/// What a rank has of the answer on a mesh. Nodes and cells are dealt out by their numbers, about as many to
/// each rank; on a grid, whose numbers run through plane after plane, that is a slab.
struct Share {
  Range own_nodes, cells; ///< each node and each cell is one rank's
  Range nodes;            ///< nodes with values on this rank: its own ones, and the vertices of its cells
};

/// A range that holds the vertices of these cells.
inline Range vertices_of(const Mesh& mesh, const Range& cells) {
  if (cells.size() == 0) return {};
  Range nodes{mesh.nodes.size(), 0};
  for (std::size_t c = cells.begin; c < cells.end; ++c)
    for (const int vertex : mesh.cells[c]) {
      nodes.begin = std::min(nodes.begin, index(vertex));
      nodes.end = std::max(nodes.end, index(vertex) + 1);
    }
  return nodes;
}

/// A rank's part of n things.
inline Range part_of(std::size_t n, int rank, int n_ranks) {
  return {n * index(rank) / index(n_ranks), n * (index(rank) + 1) / index(n_ranks)};
}

inline Share share_of(const Mesh& mesh, int rank, int n_ranks) {
  Share share{part_of(mesh.nodes.size(), rank, n_ranks), part_of(mesh.cells.size(), rank, n_ranks), {}};
  const Range vertices = vertices_of(mesh, share.cells);
  share.nodes = share.own_nodes;
  if (vertices.size() > 0)
    share.nodes = {std::min(share.own_nodes.begin, vertices.begin),
                   std::max(share.own_nodes.end, vertices.end)};
  return share;
}

/// A value of a node or a cell.
template<class Value>
struct Numbered {
  std::int64_t number;
  Value value;
};

/// The ranks that share an answer, as one of them sees them. All functions but here() are collective.
class Sharing {
 public:
  explicit Sharing(const Share& here) : here_(here) {}
  virtual ~Sharing() = default;
  Sharing(const Sharing&) = delete;
  Sharing& operator=(const Sharing&) = delete;

  const Share& here() const { return here_; }
  virtual double sum(double value) const = 0;     ///< added up in the ranks' order
  virtual double largest(double value) const = 0; ///< NaN if one is
  /// The value of a node, whoever has it.  @param held  values of here().nodes
  virtual Eigen::Vector3d at(std::size_t node, const std::vector<Eigen::Vector3d>& held) const = 0;

  /// Brings values to the ranks whose share they are in. Ranks that both give a node agree about it; what
  /// they give of a cell is added up, in the ranks' order.
  /// @return values of here().nodes, or of here().cells
  virtual std::vector<Eigen::Vector3d> deal(std::vector<Numbered<Eigen::Vector3d>> of_nodes) const = 0;
  virtual std::vector<double> deal(std::vector<Numbered<double>> of_cells) const = 0;
  /// Adds up the ranks' values of each node, in the ranks' order.  @return sums at here().nodes
  virtual std::vector<Eigen::Vector3d> add_up(std::vector<Numbered<Eigen::Vector3d>> of_nodes) const = 0;

  /// Values of all nodes, or of all cells, on every rank.
  virtual std::vector<Eigen::Vector3d> gather(const std::vector<Eigen::Vector3d>& of_nodes) const = 0;
  virtual std::vector<double> gather(const std::vector<double>& of_cells) const = 0;

 private:
  Share here_;
};

/// deal() and gather() for cells that have several numbers each, one number after the other.
template<std::size_t N>
std::vector<std::array<double, N>> deal(const Sharing& sharing,
                                        const std::vector<Numbered<std::array<double, N>>>& of_cells) {
  std::vector<std::array<double, N>> here(sharing.here().cells.size());
  for (std::size_t n = 0; n < N; ++n) {
    std::vector<Numbered<double>> one;
    for (const auto& [number, values] : of_cells) one.push_back({number, values[n]});
    const std::vector<double> dealt = sharing.deal(std::move(one));
    for (std::size_t c = 0; c < here.size(); ++c) here[c][n] = dealt[c];
  }
  return here;
}
template<std::size_t N>
std::vector<std::array<double, N>> gather(const Sharing& sharing,
                                          const std::vector<std::array<double, N>>& of_cells) {
  std::vector<std::array<double, N>> all;
  for (std::size_t n = 0; n < N; ++n) {
    std::vector<double> one;
    for (const auto& values : of_cells) one.push_back(values[n]);
    const std::vector<double> gathered = sharing.gather(one);
    all.resize(gathered.size());
    for (std::size_t c = 0; c < all.size(); ++c) all[c][n] = gathered[c];
  }
  return all;
}

/// This rank's share of a solution: all of it, where nobody shares it.
inline Share share_here(const Mesh& mesh, const Sharing* sharing) {
  const Range nodes{0, mesh.nodes.size()}, cells{0, mesh.cells.size()};
  return sharing ? sharing->here() : Share{nodes, cells, nodes};
}

/// deal(), or a list of all, where nobody shares them.
template<class Value>
std::vector<Value> deal(const Sharing* sharing, std::vector<Numbered<Value>> values, std::size_t n_all,
                        const Value& zero) {
  if (sharing) return sharing->deal(std::move(values));
  std::vector<Value> all(n_all, zero);
  for (const auto& [number, value] : values) all[index(number)] += value;
  return all;
}

} // namespace springproof::cases
