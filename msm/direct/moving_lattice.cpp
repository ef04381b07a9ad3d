#include "msm/direct/direct_system.hpp"
#include "msm/direct/entries.hpp"
#include "msm/direct/factorisation.hpp"

namespace springproof::msm {

namespace {

using Matrix = Tangent::Matrix;

bool has_terms(const Lattice& lattice) {
  bool has = false;
  for_each_kind(lattice, [&](const auto& terms) { has = has || !terms.empty(); });
  return has;
}

/// The inertia that joins nodes, in the order of the direct system.
/// @param cell_mass  consistent masses, or those times mass_damping    @param damping  damping by stiffness
Matrix joined(const Problem& problem, const std::vector<double>& cell_mass, const Lattice* damping) {
  const auto n_dofs = static_cast<Eigen::Index>(problem.is_constrained.size());
  const auto masses = masses_beyond_lumped(problem.mesh, cell_mass);
  Matrix all(n_dofs, n_dofs);
  all.setFromTriplets(masses.begin(), masses.end());
  if (damping && has_terms(*damping)) {
    Tangent whole(*damping, std::vector<bool>(problem.is_constrained.size()));
    const Matrix lower = whole.assemble(damping->rest, Clamp::no);
    all += Matrix(lower.selfadjointView<Eigen::Lower>());
  }
  std::vector<Eigen::Triplet<double>> ones;
  for_each_entry(problem, [&](std::size_t p, int c, Eigen::Index place) {
    ones.emplace_back(3 * static_cast<int>(p) + c, static_cast<int>(place), 1);
  });
  Matrix order(n_dofs, static_cast<Eigen::Index>(ones.size()));
  order.setFromTriplets(ones.begin(), ones.end());
  return order.transpose() * all * order;
}

class MovingLattice : public MovingSprings {
 public:
  MovingLattice(const Problem& problem, SpringSystem& springs, const Inertia& inertia,
                std::unique_ptr<SpringMemory> memory)
      : MovingSprings(springs, entries_of(problem, inertia,
                                          [&](const Points& points) { return on_free(problem, points); })),
        problem_(problem), springs_(springs), memory_(std::move(memory)),
        tangent_(problem.lattice, problem.is_constrained), mass_(joined(problem, inertia.cell_mass, nullptr)),
        damping_(joined(problem, inertia.cell_mass_damping, &inertia.damping)) {
    free_mass_ = on_free_dofs(entries().mass, mass_);
    free_damping_ = on_free_dofs(entries().mass_damping, damping_);
    const OneThread one;
    factorisation_.analyse(with_inertia(tangent_.assemble(problem.lattice.rest, Clamp::no), 0, 0));
  }

  void begin_motion(const Vector& at) override {
    MovingSprings::begin_motion(at);
    if (memory_) memory_->begin(to_points(problem_, at));
  }
  void set_step(const mechanics::StepTerms& terms) override {
    MovingSprings::set_step(terms);
    if (memory_) memory_->set_step(terms.duration);
  }
  void end_step(const Vector& at, double length) override {
    MovingSprings::end_step(at, length);
    if (memory_) memory_->end_step(to_points(problem_, at), length);
  }

  bool direction(const Vector& at, const Vector& residual, double /*load_factor*/, double /*forcing*/,
                 mechanics::Convexity convexity, Vector& step) override {
    if (tangent_.n_free() == 0) return false; // every point goes where its support goes
    const Clamp clamp = convexity == mechanics::Convexity::clamped ? Clamp::yes : Clamp::no;
    const OneThread one;
    ++work_.factorisations;
    Matrix matrix =
        with_inertia(tangent_.assemble(positions(problem_, at), clamp), terms().mass, terms().damping);
    if (has_tools()) add_tools(pressed_nodes(at, clamp), matrix);
    if (!factorisation_.factorise(matrix, 0)) return false;
    step.setZero(at.size());
    const auto invert = [&](const Vector& right_side, Vector& solution) {
      solution.head(tangent_.n_free()) = factorisation_.solve(right_side.head(tangent_.n_free()));
    };
    invert(residual, step);
    if (pull()) {
      with_pull_.prepare(*pull(), at.size(), invert);
      with_pull_.correct(*pull(), step);
    }
    return step.allFinite() && step.dot(residual) > 0;
  }

 private:
  const Problem& problem_;
  SpringSystem& springs_;
  std::unique_ptr<SpringMemory> memory_;
  Tangent tangent_;
  Matrix mass_, damping_;           ///< what joins nodes, of all entries of a vector
  Matrix free_mass_, free_damping_; ///< M and C on free degrees of freedom, lower triangles
  Factorisation factorisation_;
  WithPull<double> with_pull_;

  double reaction(const Vector& at) override { return springs_.reaction(at); }
  bool joins_nodes() const override { return mass_.nonZeros() > 0 || damping_.nonZeros() > 0; }
  void add_joined(double mass, double damping, const Vector& motion, Vector& product) override {
    const auto n = tangent_.n_free();
    if (mass != 0 && mass_.nonZeros() > 0) product.head(n) += mass * (mass_ * motion).head(n);
    if (damping != 0 && damping_.nonZeros() > 0) product.head(n) += damping * (damping_ * motion).head(n);
  }

  /// Lower triangle on the free degrees of freedom.
  Matrix on_free_dofs(const Vector& lumped, const Matrix& joined) const {
    const auto n = tangent_.n_free();
    Matrix lower(n, n);
    lower = lumped.head(n).asDiagonal();
    const Matrix block = joined.topLeftCorner(n, n);
    if (block.nonZeros() > 0) lower += Matrix(block.triangularView<Eigen::Lower>());
    return lower;
  }

  /// Tangent + mass M + damping C, lower triangle, of one pattern whatever the factors are.
  Matrix with_inertia(const Matrix& tangent, double mass, double damping) const {
    return tangent + mass * free_mass_ + damping * free_damping_;
  }

  /// Every point of the surface has springs, so that the pattern has its block.
  static void add_tools(const std::vector<PressedNode>& nodes, Matrix& tangent) {
    for (const PressedNode& node : nodes)
      for (int c = 0; c < 3; ++c)
        for (int r = c; r < 3; ++r) {
          const Eigen::Index row = node.entries[cases::index(r)], column = node.entries[cases::index(c)];
          if (row >= 0 && column >= 0) tangent.coeffRef(row, column) += node.tangent(r, c);
        }
  }
};

} // namespace

std::unique_ptr<MovingSprings> make_moving_lattice(const Problem& problem, SpringSystem& springs,
                                                   const Inertia& inertia,
                                                   std::unique_ptr<SpringMemory> memory) {
  return std::make_unique<MovingLattice>(problem, springs, inertia, std::move(memory));
}

} // namespace springproof::msm
