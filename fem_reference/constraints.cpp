#include "fem_reference/constraints.hpp"

#include <algorithm>
#include <set>
#include <utility>

namespace springproof::fem_reference {

namespace {

using cases::index;
using Eigen::Vector3d;

/// A vertex, an edge or a face by its vertices' numbers.
using Part = std::set<int>;

/// The vertices, edges and faces of a selection, edges of its faces included.
std::set<Part> parts_of(const cases::Selection& selection) {
  std::set<Part> parts;
  for (const int node : selection.nodes) parts.insert(Part{node});
  for (const auto& edge : selection.edges) parts.emplace(edge.begin(), edge.end());
  for (const auto& face : selection.faces) {
    parts.emplace(face.begin(), face.end());
    for (std::size_t v = 0; v < 4; ++v) parts.insert(Part{face[v], face[(v + 1) % 4]});
  }
  return parts;
}

/// Local nodes on a selection's vertices, edges and faces.
std::set<int> nodes_on(const cases::Selection& selection, const cases::Scene& scene, const Nodes& nodes) {
  const std::set<Part> parts = parts_of(selection);
  std::vector<char> is_seen(nodes.point.size());
  std::set<int> found;
  for (std::size_t i = 0; i < nodes.of_cell.size(); ++i) {
    const int node = nodes.of_cell[i];
    if (std::exchange(is_seen[index(node)], 1)) continue;
    const auto& cell = scene.mesh.cells[index(nodes.mesh_cell[i / index(nodes.per_cell)])];
    Part part;
    for (const int v : nodes.between[i % index(nodes.per_cell)]) part.insert(cell[index(v)]);
    if (parts.count(part) != 0) found.insert(node);
  }
  return found;
}

} // namespace

Constraints::Constraints(const cases::Scene& scene, const Nodes& nodes, const Prescribed& prescribed,
                         MPI_Comm communicator)
    : is_constrained(3 * nodes.point.size()), at_full_load_(3 * nodes.point.size()) {
  for (const auto& fixed : scene.constrained)
    for (const int node : nodes_on(fixed.selection, scene, nodes))
      for (std::size_t c = 0; c < 3; ++c)
        if (fixed.components[c]) is_constrained[3 * index(node) + c] = 1;
  are_moved = !scene.moved.empty();
  for (const auto& [selection, motion] : scene.moved)
    for (const int node : nodes_on(selection, scene, nodes))
      moved_.push_back({node, nodes.point[index(node)], motion});
  if (prescribed.displacement)
    for (std::size_t node = 0; node < nodes.point.size(); ++node) {
      const Vector3d value = prescribed.displacement(nodes.point[node]);
      for (std::size_t c = 0; c < 3; ++c)
        if (is_constrained[3 * node + c]) at_full_load_[3 * node + c] = value[static_cast<Eigen::Index>(c)];
    }
  n_unknowns = std::count(is_constrained.begin(), is_constrained.begin() + 3 * nodes.n_owned, 0);
  MPI_Allreduce(MPI_IN_PLACE, &n_unknowns, 1, MPI_LONG, MPI_SUM, communicator);
}

void Constraints::prescribe(double load_factor, std::vector<double>& displacement) const {
  displacement.resize(at_full_load_.size());
  for (std::size_t i = 0; i < displacement.size(); ++i) displacement[i] = load_factor * at_full_load_[i];
  prescribe_moved([=](const cases::Moved& /*motion*/) { return load_factor; }, displacement);
}

void Constraints::prescribe_at(double time, std::vector<double>& displacement) const {
  displacement.assign(at_full_load_.size(), 0);
  prescribe_moved([=](const cases::Moved& motion) { return motion.history.at(time); }, displacement);
}

/// Sets the moved degrees of freedom.  @param factor  returns the factor of a motion (Moved)
template<class Factor>
void Constraints::prescribe_moved(const Factor& factor, std::vector<double>& displacement) const {
  for (const auto& [node, rest, motion] : moved_) {
    const Vector3d value = cases::moved_by(motion, rest, factor(motion));
    for (std::size_t c = 0; c < 3; ++c)
      if (motion.components[c]) displacement[3 * index(node) + c] = value[static_cast<Eigen::Index>(c)];
  }
}

} // namespace springproof::fem_reference
