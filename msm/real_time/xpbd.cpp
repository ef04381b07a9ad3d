#include "cases/case/error.hpp"
#include "mechanics/real_time/constraint.hpp"
#include "msm/real_time/colours.hpp"
#include "msm/real_time/hooke_springs.hpp"
#include "msm/real_time/step_method.hpp"

#include <algorithm>
#include <cmath>

namespace springproof::msm {

namespace {

/// A term as a constraint: its energy is a function U of one number C of its nodes' places, a length or a
/// volume.
template<class Gradient>
struct Constraint {
  double force, slope; ///< U' and U'', of C
  Gradient gradient;   ///< dC/dx
};

Constraint<Positions<2>> constraint_of(const Link& link, const Positions<2>& x) {
  const Eigen::Vector3d d = x[1] - x[0];
  const double length = d.norm();
  const SpringSlopes slopes = spring_slopes(length, link.spring);
  return {slopes.transverse * length, slopes.along, {-d / length, d / length}};
}

Constraint<CellPositions> constraint_of(const Midline& midline, const CellPositions& x) {
  const Eigen::Vector3d d = midline.between_centres(x);
  const double length = d.norm();
  const SpringSlopes slopes = spring_slopes(length, midline.spring);
  Constraint<CellPositions> all{slopes.transverse * length, slopes.along, {}};
  for (std::size_t v = 0; v < x.size(); ++v) all.gradient[v] = midline.part(v) / length * d;
  return all;
}

template<class Volume, class Places, class Gradient>
Constraint<Gradient> constraint_of_volume(const Volume& volume, const Places& x, Gradient gradient) {
  const VolumeLaw law = volume.law(x);
  return {volume.stiffness * law.pressure, volume.stiffness / volume.rest_volume * law.slope,
          std::move(gradient)};
}
Constraint<CellPositions> constraint_of(const VolumeCell& cell, const CellPositions& x) {
  return constraint_of_volume(cell, x, volume_gradient(x));
}
Constraint<Points> constraint_of(const VolumePatch& patch, const Points& x) {
  return constraint_of_volume(patch, x, patch.gradient(x));
}

/// Projections of one term after the other (mechanics/real_time/constraint.hpp). Hooke's springs come first,
/// in an array in the order of their colours, four at a time: nearly all bodies have no other terms, or few.
class Xpbd {
 public:
  Xpbd(const Lattice& lattice, int iterations, int n_threads)
      : lattice_(lattice), iterations_(iterations), n_threads_(n_threads),
        x_(lattice.rest.size() + 2, WholePoint(0, 0, 0, 0)), mobility_(x_) {
    if (!lattice.tetrahedra.empty())
      throw cases::InputError("msm.real_time.method: tetrahedra of biquadratic springs are no constraints of "
                              "one number; choose \"vertex_block_descent\" or \"implicit_euler\"");
    const auto nodes = nodes_of_terms(lattice);
    std::vector<std::vector<int>> of_springs, of_others;
    std::vector<const Spring*> springs;
    for (std::size_t n = 0; n < nodes.size(); ++n)
      if (n < lattice.links.size() && lattice.links[n].spring.law.kind == LawKind::hooke) {
        of_springs.push_back(nodes[n]);
        springs.push_back(&lattice.links[n].spring);
      } else {
        of_others.push_back(nodes[n]);
        others_.push_back(n);
      }
    const int spare = static_cast<int>(lattice.rest.size());
    x_.back().x() = 1; // a spare spring has a length
    for (const std::vector<int>& of_colour : mechanics::colour(of_springs, lattice.rest.size())) {
      for (std::size_t n = 0; n < (of_colour.size() + 3) / 4 * 4; ++n) {
        if (n % 4 == 0) springs_.emplace_back();
        FourSprings& four = springs_.back();
        four.nodes[0][n % 4] = spare, four.nodes[1][n % 4] = spare + 1;
        four.stiffness[n % 4] = four.rest_length[n % 4] = 0;
        if (n >= of_colour.size()) continue;
        const std::size_t number = cases::index(of_colour[n]);
        for (std::size_t end = 0; end < 2; ++end) four.nodes[end][n % 4] = of_springs[number][end];
        four.stiffness[n % 4] = springs[number]->stiffness;
        four.rest_length[n % 4] = springs[number]->rest_length;
      }
      ends_of_colours_.push_back(static_cast<std::ptrdiff_t>(springs_.size()));
    }
    colours_ = mechanics::colour(of_others, lattice.rest.size());
    multipliers_.resize(others_.size());
  }

  int operator()(const StepEquation& step, Points& at) {
    begin(step, at);
    Eigen::Vector3d pulls = Eigen::Vector3d::Zero(); // N
    for (int n = 0; n < iterations_; ++n) {
      std::ptrdiff_t begin = 0;
      for (const std::ptrdiff_t end : ends_of_colours_) {
        constexpr std::ptrdiff_t at_once = 16;
        mechanics::grid::on_threads((end - begin + at_once - 1) / at_once, n_threads_, [&](std::ptrdiff_t c) {
          const std::ptrdiff_t first = begin + c * at_once;
          const std::ptrdiff_t n_at_once = std::min(at_once, end - first);
          if (is_same_in_all_directions_)
            msm::project(springs_.data() + first, n_at_once, n == 0, x_);
          else
            msm::project(springs_.data() + first, n_at_once, n == 0, x_, mobility_);
        });
        begin = end;
      }
      mechanics::for_each_item(colours_, n_threads_, [&](std::size_t number) {
        with_term(lattice_, others_[number], [&](const auto& term) { project(term, multipliers_[number]); });
      });
      if (step.pull) project(*step.pull, pulls, at);
    }
    for (std::size_t p = 0; p < at.size(); ++p) at[p] = x_[p].head<3>() - lattice_.rest[p];
    return iterations_;
  }

 private:
  const Lattice& lattice_;
  int iterations_, n_threads_;
  std::vector<FourSprings> springs_;
  std::vector<std::ptrdiff_t> ends_of_colours_;
  std::vector<std::size_t> others_; ///< numbers in nodes_of_terms()
  mechanics::Colours colours_;      ///< colours others_
  std::vector<double> multipliers_; ///< one for each of others_
  WholePoints x_,  ///< positions, mm, and two spare points that fill up the last four springs
      mobility_;   ///< D^-1, 0 on constrained components
  Points inertia_; ///< D of mobility_
  bool is_same_in_all_directions_ = false; ///< each node's mobility

  void take_inertia(const Points& inertia) {
    inertia_ = inertia;
    is_same_in_all_directions_ = true;
    for (std::size_t p = 0; p < inertia.size(); ++p) {
      for (int c = 0; c < 3; ++c) mobility_[p][c] = inertia[p][c] > 0 ? 1 / inertia[p][c] : 0;
      is_same_in_all_directions_ &= (mobility_[p].head<3>().array() == mobility_[p][0]).all();
    }
    for (FourSprings& four : springs_)
      for (int end = 0; end < 2; ++end)
        for (int s = 0; s < 4; ++s) four.mobility[end][s] = mobility_[cases::index(four.nodes[end][s])][0];
  }

  /// Lets the points go freely from where the step begins.
  void begin(const StepEquation& step, const Points& at) {
    if (step.inertia != inertia_) take_inertia(step.inertia);
    for (std::size_t p = 0; p < at.size(); ++p) {
      const Eigen::Array3d mobility = mobility_[p].head<3>();
      x_[p].head<3>() =
          lattice_.rest[p] +
          (mobility > 0).select(step.origin[p] + mobility_[p].head<3>().cwiseProduct(step.force[p]), at[p]);
    }
    std::fill(multipliers_.begin(), multipliers_.end(), 0.);
  }

  template<class Term>
  void project(const Term& term, double& multiplier) {
    const auto& nodes = nodes_of(term);
    const auto constraint = constraint_of(term, places_of(nodes));
    const auto moved_by = [&](std::size_t a, const Eigen::Vector3d& by) -> Eigen::Vector3d {
      return mobility_[cases::index(nodes[a])].template head<3>().cwiseProduct(by);
    };
    mechanics::project(
        nodes.size(), {constraint.force, constraint.slope},
        [&](std::size_t a) -> const Eigen::Vector3d& { return constraint.gradient[a]; }, moved_by, multiplier,
        [&](std::size_t a, const Eigen::Vector3d& by) {
          x_[cases::index(nodes[a])].template head<3>() += by;
        });
  }
  void project(const Tetrahedron&, double&) {} // refused above

  /// @param displacement  room, of which the pulled points' are set
  void project(const mechanics::PullOfPoints& pull, Eigen::Vector3d& force, Points& displacement) {
    for (const auto& [p, weight] : pull.weights) displacement[p] = x_[p].head<3>() - lattice_.rest[p];
    mechanics::project_pull(
        pull,
        [&](std::size_t p, const Eigen::Vector3d& by) -> Eigen::Vector3d {
          return mobility_[p].head<3>().cwiseProduct(by);
        },
        force, displacement);
    for (const auto& [p, weight] : pull.weights) x_[p].head<3>() = lattice_.rest[p] + displacement[p];
  }

  template<std::size_t n>
  Positions<n> places_of(const std::array<int, n>& nodes) const {
    Positions<n> places;
    for (std::size_t v = 0; v < n; ++v) places[v] = x_[cases::index(nodes[v])].template head<3>();
    return places;
  }
  Points places_of(const std::vector<int>& nodes) const {
    Points places;
    for (const int node : nodes) places.push_back(x_[cases::index(node)].head<3>());
    return places;
  }
};

} // namespace

MakeStep make_xpbd(const Lattice& lattice, int iterations, int n_threads) {
  return Xpbd(lattice, iterations, n_threads);
}

} // namespace springproof::msm
