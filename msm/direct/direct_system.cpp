#include "msm/direct/direct_system.hpp"

#include "mechanics/grid/lowest_mode.hpp"
#include "msm/direct/entries.hpp"
#include "msm/direct/factorisation.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace springproof::msm {

namespace {

class DirectSystem : public SpringSystem {
 public:
  explicit DirectSystem(const Problem& problem)
      : problem_(problem), n_free_(static_cast<Eigen::Index>(msm::n_unknowns(problem))),
        load_(on_free(problem, problem.on_all_points(problem.force))) {}

  const Vector& load() const override { return load_; }

  void residual(const Vector& displacement, double load_factor, mechanics::Expect,
                Vector& residual) override {
    ++work_.force_evaluations;
    residual = load_factor * load_ +
               on_free(problem_, internal_force_at(problem_.lattice, to_points(problem_, displacement)));
    if (problem_.contact) residual += on_free(problem_, contact_force(displacement, load_factor));
  }

  double energy(const Vector& displacement, double load_factor) override {
    const double of_springs = energy_at(problem_.lattice, to_points(problem_, displacement)) -
                              load_factor * load_.dot(displacement);
    if (!problem_.contact) return of_springs;
    return of_springs + problem_.contact->energy(displacements(displacement), load_factor);
  }

  std::optional<bool> is_stable(const Vector& displacement) override {
    return factorise(displacement, Clamp::no, 0);
  }

  /// Preconditions by the inverse, shifted until the tangent is positive definite.
  std::optional<Mode> lowest_mode(const Vector& displacement) override {
    double shift = 0;
    while (!factorise(displacement, Clamp::no, shift)) {
      const double largest = diagonal_.cwiseAbs().maxCoeff<Eigen::PropagateNaN>();
      if (!(largest > no_stiffness && shift < 1e3 * largest)) return std::nullopt; // or it is not a number
      shift = shift == 0 ? 1e-9 * largest : 10 * shift;
    }
    const OneThread one;
    const auto mode = mechanics::grid::lowest_mode(
        {[&](const Vector& in, Vector& out) { out = matrix_->selfadjointView<Eigen::Lower>() * in; },
         [&](const Vector& in, Vector& out) { out = factorisation_.solve(in); },
         [](const Vector& a, const Vector& b) { return a.dot(b); }, 1, 1e-8},
        random_force(1));
    if (!mode) return std::nullopt;
    return Mode{mode->eigenvalue, with_supports(mode->shape)};
  }

  mechanics::RestState rest_state() override {
    if (!problem_.contact) return rest_state_of_springs();
    is_without_tools_ = true; // they neither hold the lattice nor make it unstable
    factorised_.reset();
    const mechanics::RestState found = rest_state_of_springs();
    is_without_tools_ = false;
    factorised_.reset();
    return found;
  }

  std::string cause_of_instability() const override {
    if (has_negative_springs()) return ", because of springs of negative stiffness";
    if (has_negative_terms()) return ", because of volume terms or tetrahedra of negative stiffness";
    const Points& rest = problem_.lattice.rest;
    const std::vector<Link>& links = problem_.lattice.links;
    std::size_t n = 0;
    for (const Link& link : links)
      n += link.spring.rest_length >
           (1 + rounding) * (rest[cases::index(link.j)] - rest[cases::index(link.i)]).norm();
    return ", because springs are pressed together there: the points of " + std::to_string(n) + " of " +
           std::to_string(links.size()) + " are nearer to each other than the spring's rest length";
  }

  std::size_t n_unknowns() const override { return msm::n_unknowns(problem_); }

  int n_inverted(const Vector& displacement) override {
    return cases::n_inverted(problem_.mesh, to_points(problem_, displacement));
  }

  bool moves_supports() const override { return bool(problem_.supports); }

  void move_supports(Vector& displacement, double load_factor) const override {
    if (!problem_.supports) return;
    const Eigen::Index n = displacement.size() - n_free_;
    displacement.tail(n) =
        to_vector(problem_, problem_.on_all_points(problem_.supports(load_factor))).tail(n);
  }

 private:
  static constexpr double rounding = 1e-12; ///< far above 1e-16, far below 1e-8, the least honest pivot seen

  static constexpr double no_energy = 1e-18;     ///< between a mechanism's 1e-32 and a thin column's 1e-14
  static constexpr double no_stiffness = 1e-290; ///< N/mm; what is below is lost in double precision

  const Problem& problem_;
  Eigen::Index n_free_;
  std::optional<Tangent> tangent_; ///< made when it is first asked for
  Vector load_, diagonal_;
  const Tangent::Matrix* matrix_ = nullptr; ///< the tangent, as it was assembled last
  Factorisation factorisation_;
  std::optional<std::tuple<Vector, Clamp, double>> factorised_; ///< displacement, term and shift
  bool is_definite_ = false;

  // with tools
  double load_factor_ = 0;                       ///< the last residual's, where the tools are
  std::optional<std::pair<double, int>> seen_{}; ///< load factor and multipliers of what is factorised
  Tangent::Matrix in_contact_;                   ///< the tangent with theirs
  bool is_without_tools_ = false;                ///< the tangent is that of the springs alone

  /// A mechanism's lowest pivot is lost in rounding. So may be that of a slender or nearly incompressible
  /// body: there the answer to a random load, a huge motion, tells by what it stores.
  mechanics::RestState rest_state_of_springs() {
    using mechanics::RestState;
    const Vector rest = Vector::Zero(load_.size());
    const bool is_definite = factorise(rest, Clamp::no, 0);
    const double largest = diagonal_.cwiseAbs().maxCoeff();
    if (!(largest > no_stiffness)) return RestState::mechanism;
    if (is_definite && factorisation_.smallest_pivot_ratio(diagonal_) > rounding) return RestState::sound;
    if (is_definite && has_negative_springs()) return RestState::mechanism; // what a motion stores may cancel
    if (is_definite) {
      const Vector force = with_supports(random_force(3));
      Vector motion;
      const bool moves = solve(rest, force, 0, Clamp::no, 0, motion);
      const double stored = moves ? small_motion_energy(problem_.lattice, to_points(problem_, motion)) : 0;
      return stored > no_energy * largest * motion.squaredNorm() ? RestState::sound : RestState::mechanism;
    }
    // Positive semidefinite or indefinite? A shift that rounding could explain tells them apart.
    const double shift = rounding * largest;
    if (factorise(rest, Clamp::no, shift)) return RestState::mechanism;
    if (has_negative_terms()) return RestState::unstable;
    // Springs that are pressed together push aside what no spring holds, and what some hold if they push
    // more.
    const bool is_held =
        factorise(rest, Clamp::yes, 0) && factorisation_.smallest_pivot_ratio(diagonal_) > rounding;
    return is_held ? RestState::unstable : RestState::mechanism;
  }

  mechanics::DisplacementAt displacements(const Vector& displacement) const {
    return [points = to_points(problem_, displacement)](int node) { return points[cases::index(node)]; };
  }

  /// Returns the forces of tools on all points, N.
  Points contact_force(const Vector& displacement, double load_factor) {
    load_factor_ = load_factor;
    Points force(problem_.mesh.nodes.size(), Eigen::Vector3d::Zero());
    problem_.contact->for_each_pressed(displacements(displacement), load_factor, [&](const auto& pressed) {
      force[cases::index(pressed.node)] += pressed.force;
    });
    return force;
  }

  /// Returns the springs' tangent with that of the tools. Every point of the surface has springs, so that the
  /// pattern has its block.
  const Tangent::Matrix& with_contact(const Vector& displacement, Clamp clamp) {
    in_contact_ = *matrix_;
    const std::vector<int>& number = tangent_->free_number();
    problem_.contact->for_each_pressed(displacements(displacement), load_factor_, [&](const auto& pressed) {
      const Eigen::Matrix3d block = clamp == Clamp::yes ? pressed.stiffness : pressed.tangent();
      for (int c = 0; c < 3; ++c)
        for (int r = c; r < 3; ++r) {
          const int row = number[cases::index(3 * pressed.node + r)],
                    column = number[cases::index(3 * pressed.node + c)];
          if (row >= 0 && column >= 0) in_contact_.coeffRef(row, column) += block(r, c);
        }
    });
    return in_contact_;
  }

  bool has_negative_springs() const {
    const auto& links = problem_.lattice.links;
    return std::any_of(links.begin(), links.end(), [](const Link& l) { return l.spring.stiffness < 0; });
  }

  bool has_negative_terms() const {
    const Lattice& lattice = problem_.lattice;
    const auto has_negative = [](const auto& terms) {
      return std::any_of(terms.begin(), terms.end(), [](const auto& term) { return term.stiffness < 0; });
    };
    return has_negative_springs() || !lattice.tetrahedra.empty() || has_negative(lattice.volume_cells) ||
           has_negative(lattice.volume_patches);
  }

  double reaction(const Vector& displacement) override {
    const Points force = internal_force_at(problem_.lattice, to_points(problem_, displacement));
    double squared = 0;
    for (std::size_t d = 0; d < problem_.is_constrained.size(); ++d)
      if (problem_.is_constrained[d]) squared += std::pow(force[d / 3][static_cast<int>(d % 3)], 2);
    if (problem_.contact)
      for (const Eigen::Vector3d& pressed : contact_force(displacement, load_factor_))
        squared += pressed.squaredNorm();
    return std::sqrt(squared);
  }

  bool solve(const Vector& displacement, const Vector& residual, double /*forcing*/, Clamp clamp,
             double shift, Vector& step) override {
    if (!factorise(displacement, clamp, shift)) return false;
    const OneThread one;
    step = with_supports(factorisation_.solve(residual.head(n_free_)));
    return step.allFinite() && step.dot(residual) > 0;
  }

  /// Fixed forces on the free degrees of freedom, with a part in every motion.
  Vector random_force(unsigned seed) const {
    std::mt19937 generator(seed);
    std::normal_distribution<double> normal;
    Vector force(n_free_);
    for (double& entry : force) entry = normal(generator);
    return force;
  }
  /// A vector of the free degrees of freedom, and 0 on supports.
  Vector with_supports(const Vector& free) const {
    Vector all = Vector::Zero(load_.size());
    all.head(free.size()) = free;
    return all;
  }

  /// Factorises tangent + shift unless that is what is there. @return whether it is positive definite
  bool factorise(const Vector& displacement, Clamp clamp, double shift) {
    if (problem_.contact && seen_ != std::optional(std::pair(load_factor_, problem_.contact->revision()))) {
      seen_.emplace(load_factor_, problem_.contact->revision());
      factorised_.reset();
    }
    if (factorised_ == std::tie(displacement, clamp, shift)) return is_definite_;
    const OneThread one;
    if (!tangent_) {
      tangent_.emplace(problem_.lattice, problem_.is_constrained);
      factorisation_.analyse(tangent_->assemble(problem_.lattice.rest, Clamp::no));
    }
    matrix_ = &tangent_->assemble(positions(problem_, displacement), clamp);
    if (problem_.contact && !is_without_tools_) matrix_ = &with_contact(displacement, clamp);
    diagonal_ = matrix_->diagonal();
    ++work_.factorisations;
    factorised_.reset();
    is_definite_ = factorisation_.factorise(*matrix_, shift);
    factorised_.emplace(displacement, clamp, shift);
    return is_definite_;
  }
};

} // namespace

std::unique_ptr<SpringSystem> make_direct_system(const Problem& problem) {
  return std::make_unique<DirectSystem>(problem);
}

Points to_points(const Problem& problem, const Vector& vector) {
  Points points(problem.is_constrained.size() / 3, Eigen::Vector3d::Zero());
  for_each_entry(problem, [&](std::size_t p, int c, Eigen::Index place) { points[p][c] = vector[place]; });
  return points;
}

Vector to_vector(const Problem& problem, const Points& points) {
  const auto n_free = static_cast<Eigen::Index>(n_unknowns(problem));
  Vector vector(problem.supports ? static_cast<Eigen::Index>(problem.is_constrained.size()) : n_free);
  for_each_entry(problem, [&](std::size_t p, int c, Eigen::Index place) { vector[place] = points[p][c]; });
  return vector;
}

} // namespace springproof::msm
