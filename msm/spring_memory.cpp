#include "msm/spring_memory.hpp"

#include "cases/case/error.hpp"

#include <type_traits>

namespace springproof::msm {

namespace {

using cases::index;

template<class Term>
constexpr bool is_tetrahedron = std::is_same_v<Term, Tetrahedron>;
template<class Term>
constexpr bool is_volume = std::is_same_v<Term, VolumeCell> || std::is_same_v<Term, VolumePatch>;

/// Number of a term's forces, of which each has a memory.
template<class Term>
constexpr Eigen::Index n_forces = is_tetrahedron<Term> ? 6 : 1;

double tension(const Eigen::Vector3d& d, const Spring& spring) {
  return spring_slopes(d.norm(), spring).transverse * d.norm();
}

/// A term's elastic forces by its nodes' positions.
Vector forces_of(const Link& link, const Positions<2>& x) {
  return Vector::Constant(1, tension(x[1] - x[0], link.spring));
}
Vector forces_of(const Midline& midline, const CellPositions& x) {
  return Vector::Constant(1, tension(midline.between_centres(x), midline.spring));
}
Vector forces_of(const Tetrahedron& tetrahedron, const TetrahedronPositions& x) {
  return tetrahedron.density(x);
}
template<class Volume, class Where>
Vector forces_of(const Volume& volume, const Where& x) {
  return Vector::Constant(1, volume.stiffness * volume.law(x).pressure);
}

template<class Term>
double stiffness_of(const Term& term) {
  if constexpr (is_tetrahedron<Term>)
    return term.stiffness(0, 0);
  else if constexpr (is_volume<Term>)
    return term.stiffness;
  else
    return term.spring.stiffness;
}

/// Gives a term a step's stiffness and the forces beside it.
template<class Term>
void set_term(Term& term, const Term& elastic, const Eigen::Ref<const Vector>& factor,
              const Eigen::Ref<const Vector>& remembered) {
  if constexpr (is_tetrahedron<Term>) {
    term.stiffness = factor[0] * elastic.stiffness;
    term.remembered = remembered;
  } else if constexpr (is_volume<Term>) {
    term.stiffness = factor[0] * elastic.stiffness;
    term.remembered = remembered[0];
  } else {
    term.spring.stiffness = factor[0] * elastic.spring.stiffness;
    term.spring.remembered = remembered[0];
  }
}

/// Calls action(term, the same of the other lattice, number of its first force), in the order of the memory.
template<class AnyLattice, class Action>
void for_each_pair(AnyLattice& lattice, const Lattice& other, const Action& action) {
  Eigen::Index next = 0;
  const auto pairs = [&](auto& terms, const auto& others) {
    for (std::size_t t = 0; t < terms.size(); ++t) {
      action(terms[t], others[t], next);
      next += n_forces<std::decay_t<decltype(terms[t])>>;
    }
  };
  for_each_kind(lattice, [&](auto& terms) {
    for_each_kind(other, [&](const auto& others) {
      if constexpr (std::is_same_v<std::decay_t<decltype(terms)>, std::decay_t<decltype(others)>>)
        pairs(terms, others);
    });
  });
}

Eigen::Index count_forces(const Lattice& lattice) {
  Eigen::Index n = 0;
  for_each_kind(lattice, [&](const auto& terms) {
    using Term = typename std::decay_t<decltype(terms)>::value_type;
    n += static_cast<Eigen::Index>(terms.size()) * n_forces<Term>;
  });
  return n;
}

/// Returns what each branch adds to the terms' stiffnesses, over these: springs that cells share have the
/// mean of the cells' parts. It is found from lattices of springs that have it added.
std::vector<mechanics::FadingMemory::Branch> branches_of(const cases::Scene& scene, const SpringBody& springs,
                                                         const Lattice& lattice) {
  std::vector<mechanics::FadingMemory::Branch> branches;
  for (const mechanics::PronyBranch& branch : mechanics::prony_branches(scene.definition)) {
    const auto with_part = [&](double mechanics::PronyBranch::Parts::*part) {
      return make_lattice(scene.mesh, scaled(springs, scene.mesh.cells.size(), [&](std::size_t cell) {
                            return 1 + branch.of_material[index(cases::material_of(scene, cell))].*part;
                          }));
    };
    const Lattice with_g = with_part(&mechanics::PronyBranch::Parts::g),
                  with_k = with_part(&mechanics::PronyBranch::Parts::k);
    Vector parts = Vector::Zero(count_forces(lattice));
    const auto add_parts = [&](const Lattice& stiffened, bool of_volumes) {
      for_each_pair(lattice, stiffened, [&](const auto& term, const auto& with, Eigen::Index first) {
        using Term = std::decay_t<decltype(term)>;
        if (is_volume<Term> == of_volumes)
          // a spring in which two cells' parts cancel has none to remember
          parts.segment(first, n_forces<Term>)
              .setConstant(stiffness_of(term) != 0 ? stiffness_of(with) / stiffness_of(term) - 1 : 0);
      });
    };
    add_parts(with_g, false);
    add_parts(with_k, true);
    for (const auto& [g, k] : branch.of_material)
      if (!lattice.tetrahedra.empty() && g != k)
        throw cases::InputError(
            scene.definition.msm.where,
            "biquadratic springs are sheared and compressed as one, so material.prony must "
            "have k equal to g beside them; or take another design");
    branches.push_back({branch.tau, std::move(parts)});
  }
  return branches;
}

} // namespace

SpringMemory::SpringMemory(const cases::Scene& scene, const SpringBody& springs, Lattice& lattice)
    : lattice_(lattice), elastic_(lattice), memory_(branches_of(scene, springs, lattice)) {}

void SpringMemory::set_step(double duration) {
  memory_.set_step(duration);
  for_each_pair(lattice_, elastic_, [&](auto& term, const auto& elastic, Eigen::Index first) {
    constexpr Eigen::Index n = n_forces<std::decay_t<decltype(term)>>;
    set_term(term, elastic, memory_.factor().segment(first, n), memory_.remembered().segment(first, n));
  });
}

Vector SpringMemory::forces_at(const Points& displacement) const {
  Vector all(count_forces(elastic_));
  for_each_pair(elastic_, elastic_, [&](const auto& term, const auto&, Eigen::Index first) {
    constexpr Eigen::Index n = n_forces<std::decay_t<decltype(term)>>;
    all.segment<n>(first) = forces_of(term, seen(nodes_of(term), elastic_.rest, displacement));
  });
  return all;
}

} // namespace springproof::msm
