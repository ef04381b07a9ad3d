#include "fem_reference/real_time/vertex_elements.hpp"

#include "mechanics/grid/field.hpp"

#include <algorithm>
#include <limits>
#include <memory>

namespace springproof::fem_reference {

using cases::index;

RestCells::RestCells(const cases::Scene& scene) : scene_(scene) {
  const std::size_t n = scene.mesh.grid ? 1 : scene.mesh.cells.size();
  for (std::size_t c = 0; c < n; ++c) shapes_.emplace_back(cases::cell_corners(scene.mesh, c));
}

MakeCellLaw law_at_points(const RestCells& cells, const std::vector<Formulation>& formulations,
                          cases::Element element) {
  return [&cells, formulations, element]() -> CellLaw {
    cases::Fem fem;
    fem.element = element;
    std::vector<std::shared_ptr<CellKernel>> kernels;
    for (const Formulation& formulation : formulations)
      kernels.push_back(formulation.make_kernel(element_type(fem, formulation)));
    return [&cells, kernels](std::size_t cell, const CellVector& displacement, Wanted wanted,
                             CellForces& found) {
      CellKernel& kernel = *kernels[index(cases::material_of(cells.scene(), cell))];
      const CellResult& result =
          kernel.evaluate(cells.shape(cell).geometry(), displacement.data(), nullptr, wanted);
      if (!result.valid) return false;
      const Eigen::Index n = displacement.size() / 3; // the kernel numbers degrees of freedom i*n + a
      found.force.resize(3 * n);
      for (Eigen::Index d = 0; d < 3 * n; ++d) found.force[3 * (d % n) + d / n] = -result.force[d];
      if (wanted == Wanted::stress) return true;
      found.tangent.resize(3 * n, 3 * n);
      for (Eigen::Index r = 0; r < 3 * n; ++r)
        for (Eigen::Index c = 0; c < 3 * n; ++c)
          found.tangent(3 * (r % n) + r / n, 3 * (c % n) + c / n) = result.tangent(r, c);
      return true;
    };
  };
}

VertexElements::VertexElements(const RestCells& cells, const MakeCellLaw& make_law, int n_threads)
    : cells_(cells), n_threads_(n_threads), force_(cells.scene().mesh.cells.size()),
      at_node_(cells.scene().mesh.nodes.size()),
      matrix_(cases::constrained_dofs(cells.scene()), [&](const auto& sink) {
        for (const cases::CellNodes& nodes : cells.scene().mesh.cells)
          for (const int row : nodes)
            for (const int column : nodes)
              if (row >= column) sink(row, column, Eigen::Matrix3d());
      }) {
  for (int thread = 0; thread < n_threads; ++thread) laws_.push_back(make_law());
  for (std::size_t cell = 0; cell < force_.size(); ++cell) {
    const cases::CellNodes nodes = cells.scene().mesh.cells[cell];
    for (std::size_t v = 0; v < nodes.size(); ++v) at_node_[index(nodes[v])].push_back({cell, v});
  }
}

CellVector VertexElements::in_cell(std::size_t cell, const Points& displacement) const {
  const cases::CellNodes nodes = cells_.scene().mesh.cells[cell];
  CellVector u(3 * static_cast<Eigen::Index>(nodes.size()));
  for (std::size_t v = 0; v < nodes.size(); ++v)
    u.segment<3>(3 * static_cast<Eigen::Index>(v)) = displacement[index(nodes[v])];
  return u;
}

Points VertexElements::forces(const Points& displacement) {
  using mechanics::grid::on_threads;
  const std::size_t n_of_thread = (force_.size() + laws_.size() - 1) / laws_.size();
  on_threads(n_threads_, n_threads_, [&](std::ptrdiff_t thread) {
    const std::size_t first = std::size_t(thread) * n_of_thread,
                      end = std::min(force_.size(), first + n_of_thread);
    CellForces found;
    for (std::size_t cell = first; cell < end; ++cell) {
      const CellVector u = in_cell(cell, displacement);
      const bool is_finite = laws_[std::size_t(thread)](cell, u, Wanted::stress, found);
      force_[cell] =
          is_finite ? found.force : CellVector::Constant(u.size(), std::numeric_limits<double>::quiet_NaN());
    }
  });
  Points sums(at_node_.size(), Eigen::Vector3d::Zero());
  on_threads(static_cast<std::ptrdiff_t>(sums.size()), n_threads_, [&](std::ptrdiff_t node) {
    for (const auto& [cell, vertex] : at_node_[std::size_t(node)])
      sums[std::size_t(node)] += force_[cell].segment<3>(3 * static_cast<Eigen::Index>(vertex));
  });
  return sums;
}

mechanics::ForcesAt VertexElements::forces() {
  return [this](const Points& displacement) { return forces(displacement); };
}

template<class Sink>
void VertexElements::visit_blocks(const Points& displacement, const Sink& sink) {
  CellForces found;
  for (std::size_t cell = 0; cell < force_.size(); ++cell) {
    const cases::CellNodes nodes = cells_.scene().mesh.cells[cell];
    const CellVector u = in_cell(cell, displacement);
    if (!laws_.front()(cell, u, Wanted::stress_and_tangent, found))
      found.tangent.setConstant(u.size(), u.size(), std::numeric_limits<double>::quiet_NaN());
    for (std::size_t a = 0; a < nodes.size(); ++a)
      for (std::size_t b = 0; b < nodes.size(); ++b)
        if (nodes[a] >= nodes[b])
          sink(nodes[a], nodes[b],
               Eigen::Matrix3d(found.tangent.block<3, 3>(3 * static_cast<Eigen::Index>(a),
                                                         3 * static_cast<Eigen::Index>(b))));
  }
}

mechanics::FreeTangent VertexElements::tangent() {
  return {matrix_.free_number(), matrix_.n_free(),
          [this](const Points& displacement) -> const mechanics::BlockMatrix::Matrix& {
            return matrix_.assemble([&](const auto& sink) { visit_blocks(displacement, sink); });
          }};
}

} // namespace springproof::fem_reference
