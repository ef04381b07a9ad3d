#include "fem_reference/vibrating_elements.hpp"

#include "fem_reference/assembled_body.hpp"

namespace springproof::fem_reference {

namespace {

/// Rows and columns of free degrees of freedom.  @param number  of each among them, or -1
Eigen::SparseMatrix<double> on_free_dofs(const LocalMatrix& all, const std::vector<int>& number, int n_free) {
  std::vector<Eigen::Triplet<double>> entries;
  for (Eigen::Index row = 0; row < all.rows(); ++row)
    for (LocalMatrix::InnerIterator entry(all, row); entry; ++entry) {
      const int r = number[cases::index(row)], c = number[cases::index(entry.col())];
      if (r >= 0 && c >= 0) entries.emplace_back(r, c, entry.value());
    }
  Eigen::SparseMatrix<double> free(n_free, n_free);
  free.setFromTriplets(entries.begin(), entries.end());
  return free;
}

} // namespace

mechanics::VibratingBody vibrating_body(const cases::Scene& scene) {
  const AssembledBody body(scene, MPI_COMM_SELF);
  const Discretisation& d = body.discretisation;
  mechanics::VibratingBody result;
  std::vector<int> number;
  int n_free = 0;
  for (std::size_t i = 0; i < d.constraints.is_constrained.size(); ++i) {
    number.push_back(d.constraints.is_constrained[i] ? -1 : n_free);
    if (d.constraints.is_constrained[i]) continue;
    ++n_free;
    const int node = d.nodes.mesh_node[i / 3];
    const bool is_of_body = node >= 0 && cases::index(node) < scene.mesh.nodes.size();
    result.mesh_dof.push_back(is_of_body ? 3 * node + static_cast<int>(i % 3) : -1);
  }
  const cases::Scene refined = cases::refine(scene, scene.definition.fem.refine);
  result.stiffness = on_free_dofs(rest_stiffness(d, body.formulations), number, n_free);
  result.mass = on_free_dofs(make_inertia(refined, d, body.formulations).mass, number, n_free);
  return result;
}

} // namespace springproof::fem_reference
