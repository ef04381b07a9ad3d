#include "fem_reference/grid/moving_grid.hpp"

namespace springproof::fem_reference::grid {

MovingGrid::MovingGrid(const cases::Scene& scene, const Places& places, const Supported& supported,
                       GridEquations& equations, int n_threads)
    : body_(places.body), supported_(supported), equations_(equations), inertia_(scene, places, n_threads),
      loads_(loads_in_time(scene, false, places)) {}

void MovingGrid::external_force(double time, Vector& force) {
  force = equations_.rest();
  for (const mechanics::LoadInTime& load : loads_) load.add(time, force);
}

void MovingGrid::supports_at(double time, Vector& displacement) const {
  if (!supported_.prescribed_at) return;
  const std::vector<double> values = supported_.prescribed_at(time);
  for (std::size_t m = 0; m < values.size(); ++m) displacement[supported_.moved[m]] = values[m];
}

/// Pressures follow from displacements in each step.
void MovingGrid::complete(Vector& motion) {
  body_.slab.update_ghosts(body_.layout, motion.data());
}

void MovingGrid::set_step(const mechanics::StepTerms& terms) {
  const bool is_another = inertia_.set_step({terms.mass, terms.damping});
  equations_.set_step(terms, inertia_, is_another);
}

/// On free degrees of freedom; 0 elsewhere.
void MovingGrid::multiply(double mass, double damping, const Vector& motion, Vector& product) {
  motion_ = motion.head(equations_.n_displacements());
  body_.slab.update_ghosts(body_.layout, motion_.data());
  product_.setZero(motion_.size());
  inertia_.add_product({mass, damping}, motion_, product_);
  product.setZero(motion.size());
  product.head(product_.size()) = product_.cwiseProduct(body_.free.cast<double>());
}

} // namespace springproof::fem_reference::grid
