#include "cases/case/error.hpp"
#include "msm/real_time/colours.hpp"
#include "msm/real_time/step_method.hpp"

#include <algorithm>

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

/// Projections with multipliers lambda = -U'(C), which Newton's method for one constraint after the other
/// finds:
///   d lambda = -(U' + lambda)/(1 + U'' w),  w = grad C . D^-1 grad C,  dx = D^-1 grad C d lambda.
/// For U = k C²/2 that is the update of Macklin et al. (2016), eq. 18, of compliance 1/k, times D in place of
/// M/h². Constraints whose energy curves down take the first part of 1 alone.
class Xpbd {
 public:
  Xpbd(const Lattice& lattice, int iterations, int n_threads)
      : lattice_(lattice), iterations_(iterations), n_threads_(n_threads) {
    if (!lattice.tetrahedra.empty())
      throw cases::InputError("msm.real_time.method: tetrahedra of biquadratic springs are no constraints of "
                              "one number; choose \"vertex_block_descent\" or \"implicit_euler\"");
    const auto nodes = nodes_of_terms(lattice);
    colours_ = colour(nodes, lattice.rest.size());
    multipliers_.resize(nodes.size());
  }

  int operator()(const StepEquation& step, Points& at) {
    step.go_freely(at);
    for (std::size_t p = 0; p < at.size(); ++p) at[p] += lattice_.rest[p];
    std::fill(multipliers_.begin(), multipliers_.end(), 0.);
    for (int n = 0; n < iterations_; ++n)
      for_each_item(colours_, n_threads_, [&](std::size_t number) {
        with_term(lattice_, number, [&](const auto& term) { project(step, term, multipliers_[number], at); });
      });
    for (std::size_t p = 0; p < at.size(); ++p) at[p] -= lattice_.rest[p];
    return iterations_;
  }

 private:
  const Lattice& lattice_;
  int iterations_, n_threads_;
  Colours colours_;
  std::vector<double> multipliers_; ///< one per term

  template<class Term>
  static void project(const StepEquation& step, const Term& term, double& multiplier, Points& x) {
    const auto nodes = nodes_of(term);
    const auto constraint = constraint_of(term, at_nodes(nodes, x));
    double weight = 0;
    for (std::size_t a = 0; a < nodes.size(); ++a)
      weight += constraint.gradient[a].dot(step.moved_by(cases::index(nodes[a]), constraint.gradient[a]));
    if (weight == 0) return; // between supports
    const double change = -(constraint.force + multiplier) / (1 + std::max(constraint.slope, 0.) * weight);
    multiplier += change;
    for (std::size_t a = 0; a < nodes.size(); ++a)
      x[cases::index(nodes[a])] += step.moved_by(cases::index(nodes[a]), change * constraint.gradient[a]);
  }
  static void project(const StepEquation&, const Tetrahedron&, double&, Points&) {} // refused above
};

} // namespace

MakeStep make_xpbd(const Lattice& lattice, int iterations, int n_threads) {
  return Xpbd(lattice, iterations, n_threads);
}

} // namespace springproof::msm
