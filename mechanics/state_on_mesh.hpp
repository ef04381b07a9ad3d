#pragma once

#include "cases/case/solution.hpp"
#include "cases/mesh/sharing.hpp"

#include <functional>
#include <numeric>
#include <utility>

namespace springproof::mechanics {

/// The states of a model on the body's own mesh. Every rank gives what it computes of a state, and gets what
/// is its share. Member functions are collective.
class StateOnMesh {
 public:
  using State = Eigen::VectorXd;
  struct Parts {
    /// Displacements of the nodes that this rank computes, mm.
    std::function<std::vector<cases::Numbered<Eigen::Vector3d>>(const State&)> displacements;
    /// Deformed volumes that this rank's elements add to cells, mm³.
    std::function<std::vector<cases::Numbered<double>>(const State&)> cell_volumes;
  };
  /// @param mesh     must outlive this
  /// @param sharing  null: one rank has all
  StateOnMesh(const cases::Mesh& mesh, std::shared_ptr<const cases::Sharing> sharing, Parts parts)
      : mesh_(mesh), sharing_(std::move(sharing)), parts_(std::move(parts)) {}

  /// Puts the displacement, the cells' volumes and the number of inverted cells into a solution, which the
  /// ranks then share.
  void add_to(cases::Solution& solution, const State& state) const {
    solution.sharing = sharing_;
    solution.displacement = displacement(state);
    solution.cell_volume = cell_volumes(state);
    solution.inverted_cells = cases::n_inverted(mesh_, solution.displacement, sharing_.get());
  }
  /// The displacement of all nodes on every rank, mm.
  std::vector<Eigen::Vector3d> whole_displacement(const State& state) const {
    std::vector<Eigen::Vector3d> here = displacement(state);
    return sharing_ ? sharing_->gather(here) : here;
  }
  /// The body's volume, mm³, summed in the order of the cells: the same on any number of ranks.
  double volume(const State& state) const {
    std::vector<double> of_cells = cell_volumes(state);
    if (sharing_) of_cells = sharing_->gather(of_cells);
    return std::accumulate(of_cells.begin(), of_cells.end(), 0.);
  }

 private:
  const cases::Mesh& mesh_;
  std::shared_ptr<const cases::Sharing> sharing_;
  Parts parts_;

  std::vector<Eigen::Vector3d> displacement(const State& state) const {
    return cases::deal(sharing_.get(), parts_.displacements(state), mesh_.nodes.size(),
                       Eigen::Vector3d(0, 0, 0));
  }
  std::vector<double> cell_volumes(const State& state) const {
    return cases::deal(sharing_.get(), parts_.cell_volumes(state), mesh_.cells.size(), 0.);
  }
};

} // namespace springproof::mechanics
