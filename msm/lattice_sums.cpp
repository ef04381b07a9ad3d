#include "msm/lattice.hpp"
#include "msm/tangent.hpp"

#include <algorithm>
#include <type_traits>

namespace springproof::msm {

namespace {

using cases::index;
using Eigen::Matrix3d;
using Eigen::Vector3d;

/// The nodes of a term as seen from the first, at positions or displaced from rest.
template<std::size_t n>
SPRINGPROOF_INLINE Positions<n> seen(const std::array<int, n>& nodes, const Points& positions) {
  if constexpr (n == 2) // a spring takes the difference of its ends itself
    return {positions[index(nodes[0])], positions[index(nodes[1])]};
  Positions<n> x = at_nodes(nodes, positions);
  for (std::size_t v = n; v-- > 0;) x[v] -= x[0];
  return x;
}
SPRINGPROOF_INLINE Points seen(const std::vector<int>& nodes, const Points& positions) {
  Points x = at_nodes(nodes, positions);
  for (std::size_t v = x.size(); v-- > 0;) x[v] -= x[0];
  return x;
}
using msm::seen;

template<class Energy>
double sum_over_terms(const Lattice& lattice, const Energy& energy_of) {
  double sum = 0;
  for_each_kind(lattice, [&](const auto& terms) {
    for (const auto& term : terms) sum += energy_of(term, nodes_of(term));
  });
  return sum;
}

/// @param points  positions, or rest and displacement
template<class... Places>
double energy_of(const Lattice& lattice, const Places&... points) {
  return sum_over_terms(
      lattice, [&](const auto& term, const auto& nodes) { return term.energy(seen(nodes, points...)); });
}

template<class Term, class... Places>
void add_forces(const Term& term, Points& force, const Places&... points) {
  const auto forces = term.forces(seen(term.nodes, points...));
  for (std::size_t v = 0; v < term.nodes.size(); ++v) force[index(term.nodes[v])] += forces[v];
}
Vector3d between(const Link& link, const Points& positions) {
  return positions[index(link.j)] - positions[index(link.i)];
}
Vector3d between(const Link& link, const Points& rest, const Points& displacement) {
  return between(link, rest) + between(link, displacement);
}
/// A spring's two forces are one vector: by way of arrays they take a tenth longer.
template<class... Places>
void add_forces(const Link& link, Points& force, const Places&... points) {
  const Vector3d pull = spring_force(between(link, points...), link.spring);
  force[index(link.i)] += pull;
  force[index(link.j)] -= pull;
}

/// @param points  positions, or rest and displacement
template<class... Places>
Points force_of(const Lattice& lattice, const Places&... points) {
  Points force(lattice.rest.size(), Vector3d::Zero());
  for_each_kind(lattice, [&](const auto& terms) {
    for (const auto& term : terms) add_forces(term, force, points...);
  });
  return force;
}

/// Whether a spring is under no tension at rest; other terms never are.
bool is_relaxed(const Link& link, const Positions<2>& rest) {
  const double length = (rest[1] - rest[0]).norm();
  return std::abs(length - link.spring.rest_length) <= 1e-12 * length;
}
template<class Term, class Rest>
bool is_relaxed(const Term&, const Rest&) {
  return true;
}

/// What has a term's stiffness and what it remembers.
template<class Term>
auto& carrier_of(Term& term) {
  if constexpr (std::is_same_v<std::decay_t<Term>, Link> || std::is_same_v<std::decay_t<Term>, Midline>)
    return term.spring;
  else
    return term;
}

bool remembers(const Lattice& lattice) {
  const auto is_zero = [](const auto& remembered) {
    if constexpr (std::is_same_v<std::decay_t<decltype(remembered)>, double>)
      return remembered == 0;
    else
      return remembered.isZero(0);
  };
  bool any = false;
  for_each_kind(lattice, [&](const auto& terms) {
    any = any || std::any_of(terms.begin(), terms.end(),
                             [&](const auto& term) { return !is_zero(carrier_of(term).remembered); });
  });
  return any;
}

/// The lattice with its stiffnesses alone, and with what it remembers alone.
Lattice of_laws(Lattice lattice) {
  for_each_kind(lattice, [](auto& terms) {
    for (auto& term : terms) carrier_of(term).remembered *= 0;
  });
  return lattice;
}
Lattice of_memory(Lattice lattice) {
  for_each_kind(lattice, [](auto& terms) {
    for (auto& term : terms) carrier_of(term).stiffness *= 0;
  });
  return lattice;
}

/// Whether no edge of a term changes by midpoint_below of its length, and none is under tension at rest.
bool is_small(const Lattice& lattice, const Points& displacement) {
  bool are_small = true;
  for_each_kind(lattice, [&](const auto& terms) {
    are_small =
        are_small && std::all_of(terms.begin(), terms.end(), [&](const auto& term) {
          const auto rest = at_nodes(nodes_of(term), lattice.rest),
                     moved = at_nodes(nodes_of(term), displacement);
          return is_relaxed(term, rest) &&
                 std::all_of(term.edges.begin(), term.edges.end(), [&](const std::array<int, 2>& edge) {
                   const std::size_t a = index(edge[0]), b = index(edge[1]);
                   return (moved[b] - moved[a]).norm() < midpoint_below * (rest[b] - rest[a]).norm();
                 });
        });
  });
  return are_small;
}

/// K(u part) u, with the tangent at a part of the way to the displacement, as seen from the first point.
Points tangent_product(const Lattice& lattice, const Points& displacement, double part) {
  Points at = lattice.rest, product(at.size(), Vector3d::Zero());
  for (std::size_t p = 0; p < at.size(); ++p)
    at[p] = (lattice.rest[p] - lattice.rest[0]) + part * displacement[p];
  visit_tangent_blocks(lattice, at, Clamp::no, [&](int row, int column, const Matrix3d& block) {
    product[index(row)] += block * displacement[index(column)];
    if (row != column) product[index(column)] += block.transpose() * displacement[index(row)];
  });
  return product;
}

} // namespace

double energy(const Lattice& lattice, const Points& positions) {
  return energy_of(lattice, positions);
}

double energy_at(const Lattice& lattice, const Points& displacement) {
  if (!is_small(lattice, displacement)) return energy_of(lattice, lattice.rest, displacement);
  if (remembers(lattice)) { // these forces hardly change: the midpoint rule for their work
    Points half = displacement;
    for (Vector3d& way : half) way /= 2;
    const Points force = force_of(of_memory(lattice), lattice.rest, half);
    double work = 0;
    for (std::size_t p = 0; p < force.size(); ++p) work += force[p].dot(displacement[p]);
    return energy_at(of_laws(lattice), displacement) - work;
  }
  const Points force = tangent_product(lattice, displacement, 1. / 3);
  double sum = 0;
  for (std::size_t p = 0; p < force.size(); ++p) sum += force[p].dot(displacement[p]) / 2;
  return sum;
}

double small_motion_energy(const Lattice& lattice, const Points& motion) {
  return sum_over_terms(lattice, [&](const auto& term, const auto& nodes) {
    return term.small_motion_energy(at_nodes(nodes, lattice.rest), at_nodes(nodes, motion));
  });
}

Points internal_force(const Lattice& lattice, const Points& positions) {
  return force_of(lattice, positions);
}

Points internal_force_at(const Lattice& lattice, const Points& displacement) {
  if (!is_small(lattice, displacement)) return force_of(lattice, lattice.rest, displacement);
  if (remembers(lattice)) {
    Points force = internal_force_at(of_laws(lattice), displacement);
    const Points more = force_of(of_memory(lattice), lattice.rest, displacement);
    for (std::size_t p = 0; p < force.size(); ++p) force[p] += more[p];
    return force;
  }
  Points force = tangent_product(lattice, displacement, 0.5);
  for (Vector3d& of_point : force) of_point = -of_point;
  return force;
}

} // namespace springproof::msm
