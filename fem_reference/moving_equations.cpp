#include "fem_reference/moving_equations.hpp"

namespace springproof::fem_reference {

using cases::index;

MovingEquations::MovingEquations(const cases::Scene& scene, const Discretisation& discretisation,
                                 const std::vector<Formulation>& formulations,
                                 EquilibriumEquations& equations)
    : discretisation_(discretisation), equations_(equations),
      inertia_(make_inertia(scene, discretisation, formulations)), motion_(discretisation.make_vector()),
      product_(discretisation.make_vector()) {
  const auto& is_constrained = discretisation.constraints.is_constrained;
  cases::Scene alone = scene;
  for (const auto& applied : scene.loads) {
    alone.loads = {applied};
    const std::vector<double> load = discretisation.load_of(alone);
    State force = equations.rest();
    for (std::size_t i = 0; i < load.size(); ++i)
      if (!is_constrained[i]) force[static_cast<Eigen::Index>(i)] = load[i];
    loads_.emplace_back(applied.load.history, force);
  }
  added_ = 0. * inertia_.mass + 0. * inertia_.damping; // the pattern of every step
}

void MovingEquations::external_force(double time, State& force) {
  force = equations_.rest();
  for (const mechanics::LoadInTime& load : loads_) load.add(time, force);
}

void MovingEquations::supports_at(double time, State& displacement) const {
  const auto& constraints = discretisation_.constraints;
  std::vector<double> prescribed;
  constraints.prescribe_at(time, prescribed);
  for (std::size_t i = 0; i < prescribed.size(); ++i)
    if (constraints.is_constrained[i]) displacement[static_cast<Eigen::Index>(i)] = prescribed[i];
}

void MovingEquations::set_step(const mechanics::StepTerms& terms) {
  const bool is_another = terms.mass != mass_ || terms.damping != damping_;
  if (is_another) {
    mass_ = terms.mass;
    damping_ = terms.damping;
    added_ = mass_ * inertia_.mass + damping_ * inertia_.damping;
  }
  equations_.set_step({added_, terms.origin, terms.force, terms.supports, terms.scale}, is_another);
}

/// On free degrees of freedom of this rank; 0 elsewhere.
void MovingEquations::multiply(const LocalMatrix& matrix, const State& motion, State& product) {
  const auto n = static_cast<Eigen::Index>(discretisation_.constraints.is_constrained.size());
  {
    const WriteEntries all(motion_.get());
    Eigen::Map<State>(all.data(), n) = motion.head(n);
  }
  mechanics::petsc::update_ghosts(motion_.get());
  {
    const ReadEntries from(motion_.get());
    const WriteEntries to(product_.get());
    Eigen::Map<State>(to.data(), n) = matrix * Eigen::Map<const State>(from.data(), n);
  }
  mechanics::petsc::add_ghosts(product_.get());
  product.setZero(motion.size());
  const ReadEntries of_all(product_.get());
  for (int i = 0; i < 3 * discretisation_.nodes.n_owned; ++i)
    if (!discretisation_.constraints.is_constrained[index(i)]) product[i] = of_all[i];
}

} // namespace springproof::fem_reference
