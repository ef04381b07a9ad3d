#include "fem_reference/real_time/xpbd.hpp"

#include "fem_reference/law_kernel.hpp"
#include "mechanics/elastic_moduli.hpp"
#include "mechanics/laws/neo_hookean.hpp"
#include "mechanics/real_time/colours.hpp"
#include "mechanics/real_time/constraint.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <utility>

namespace springproof::fem_reference {

template<>
constexpr bool is_finite_inside_out<AtPoint<mechanics::NeoHookean>> = true;

namespace {

using NeoHookean = AtPoint<mechanics::NeoHookean>;
using cases::index;
using Gradients = Eigen::Matrix<double, 3, 4>; ///< a column a vertex

class Xpbd {
 public:
  Xpbd(const RestCells& cells, int iterations, int n_threads)
      : iterations_(iterations), n_threads_(n_threads) {
    const auto materials = cases::materials_of(cells.scene().definition);
    std::vector<std::vector<int>> touched;
    for (std::size_t c = 0; c < cells.scene().mesh.cells.size(); ++c) {
      const cases::CellNodes nodes = cells.scene().mesh.cells[c];
      touched.emplace_back(nodes.begin(), nodes.end());
      const auto& material =
          std::get<cases::LinearElastic>(materials[index(cases::material_of(cells.scene(), c))]);
      const mechanics::ElasticModuli moduli = mechanics::elastic_moduli(material);
      const double lambda = moduli.lambda + moduli.mu, volume = cells.shape(c).volume();
      cells_.push_back({{nodes[0], nodes[1], nodes[2], nodes[3]},
                        cells.shape(c).mean_gradients(),
                        volume * moduli.mu,
                        volume * lambda,
                        moduli.mu / lambda});
    }
    colours_ = mechanics::colour(touched, cells.scene().mesh.nodes.size());
    multipliers_.resize(cells_.size());
  }

  int operator()(const mechanics::StepEquation& step, Points& at) {
    step.go_freely(at);
    std::fill(multipliers_.begin(), multipliers_.end(), std::array<double, 2>{});
    Eigen::Vector3d pulls = Eigen::Vector3d::Zero(); // N
    for (int n = 0; n < iterations_; ++n) {
      mechanics::for_each_item(colours_, n_threads_, [&](std::size_t cell) {
        project_deviatoric(step, cells_[cell], multipliers_[cell][0], at);
        project_hydrostatic(step, cells_[cell], multipliers_[cell][1], at);
      });
      if (step.pull)
        mechanics::project_pull(
            *step.pull, [&](std::size_t p, const Eigen::Vector3d& by) { return step.moved_by(p, by); }, pulls,
            at);
    }
    return iterations_;
  }

 private:
  struct Cell {
    std::array<int, 4> nodes;
    Gradients gradients;      ///< dN_a/dX
    double shear, volumetric; ///< mu V and lambda' V, N mm
    double offset;            ///< mu/lambda'
  };
  int iterations_, n_threads_;
  std::vector<Cell> cells_;
  mechanics::Colours colours_;
  std::vector<std::array<double, 2>> multipliers_;

  static Matrix3 displacement_gradient(const Cell& cell, const Points& at) {
    Matrix3 h = Matrix3::Zero();
    for (int a = 0; a < 4; ++a) h += at[index(cell.nodes[index(a)])] * cell.gradients.col(a).transpose();
    return h;
  }

  /// @param by_gradient  dC/dF
  static void project(const mechanics::StepEquation& step, const Cell& cell,
                      const mechanics::ConstraintEnergy& energy, const Matrix3& by_gradient,
                      double& multiplier, Points& at) {
    const Gradients gradients = by_gradient * cell.gradients;
    const auto node = [&](std::size_t a) { return index(cell.nodes[a]); };
    mechanics::project(
        4, energy, [&](std::size_t a) { return gradients.col(static_cast<Eigen::Index>(a)); },
        [&](std::size_t a, const Eigen::Vector3d& by) { return step.moved_by(node(a), by); }, multiplier,
        [&](std::size_t a, const Eigen::Vector3d& by) { at[node(a)] += by; });
  }

  /// C = |F| with the energy mu V C²/2.
  static void project_deviatoric(const mechanics::StepEquation& step, const Cell& cell, double& multiplier,
                                 Points& at) {
    const Matrix3 f = Matrix3::Identity() + displacement_gradient(cell, at);
    const double size = f.norm();
    if (size > 0) project(step, cell, {cell.shear * size, cell.shear}, f / size, multiplier, at);
  }

  /// C = J - 1 - mu/lambda' with the energy lambda' V C²/2.
  static void project_hydrostatic(const mechanics::StepEquation& step, const Cell& cell, double& multiplier,
                                  Points& at) {
    const Matrix3 h = displacement_gradient(cell, at);
    const double c = dilatation(Kinematics::finite, h) - cell.offset;
    const Matrix3 area = cofactor(Kinematics::finite, Matrix3::Identity() + h);
    project(step, cell, {cell.volumetric * c, cell.volumetric}, area, multiplier, at);
  }
};

} // namespace

mechanics::MakeStep make_xpbd(const RestCells& cells, int iterations, int n_threads) {
  return Xpbd(cells, iterations, n_threads);
}

std::vector<Formulation> neo_hookean(const cases::Scene& scene) {
  std::vector<Formulation> formulations;
  for (const cases::Material& material : cases::materials_of(scene.definition))
    formulations.push_back({{NeoHookean::traits},
                            [law = NeoHookean(std::get<cases::LinearElastic>(material))](
                                const ElementType& element) -> std::unique_ptr<CellKernel> {
                              return std::make_unique<LawKernel<NeoHookean>>(element, law);
                            }});
  return formulations;
}

} // namespace springproof::fem_reference
