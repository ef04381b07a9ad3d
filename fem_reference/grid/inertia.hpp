#pragma once

#include "cases/scene/scene.hpp"
#include "fem_reference/grid/body.hpp"

#include <memory>
#include <optional>

namespace springproof::fem_reference::grid {

/// Masses and damping of trilinear elements on a grid: consistent or lumped, as fem.mass says, what [[mass]]
/// adds to nodes, and C = mass_damping M + stiffness_damping K(rest), cell by cell.
class Inertia {
 public:
  /// @param scene   the scene on the elements' mesh
  /// @param places  those of the body, which must outlive this
  Inertia(const cases::Scene& scene, const Places& places, int n_threads);

  /// Factors in mass M + damping C: 1/s², 1/s.
  struct Factors {
    double mass = 0, damping = 0;
  };
  /// product += (mass M + damping C) field, on all entries; the field's ghosts are current.
  void add_product(const Factors& factors, const Field<double>& field, Field<double>& product);

  /// Sets the factors of a step in time, for its residuals and its tangent.
  /// @return whether they differ from those before
  bool set_step(const Factors& factors);
  void add_step_product(const Field<double>& field, Field<double>& product) {
    add_product(step_, field, product);
  }
  Masses<double> step_masses() const; ///< the cells'; points into this
  const Field<double>& step_node_masses() const { return step_node_masses_; } ///< [[mass]]; empty: none
  /// A linear body whose tangent is the step's multiple of K(rest); nothing where there is none.
  std::optional<Cells> step_damping() const;

 private:
  const Body& body_;
  int n_threads_;
  bool is_lumped_;
  std::vector<double> mass_of_cell_, damped_mass_of_cell_; ///< t, t/s
  Field<double> node_mass_;                                ///< t
  std::unique_ptr<Body> damping_body_; ///< moduli times stiffness_damping, N s/mm²; null: no such damping
  Factors step_;
  std::vector<double> step_masses_, factored_; ///< t/s²: the step's, and the last product's
  Field<double> step_node_masses_;
  Field<double> force_, condensed_; ///< the damping body's

  void factor(const Factors& factors, std::vector<double>& masses) const;
  /// Masses of cells with the weights of fem.mass.
  Masses<double> of_kind(const std::vector<double>& masses) const;
  Cells damping_view(double factor) const;
  void make_damping_body(const cases::Scene& scene, const Places& places);
};

} // namespace springproof::fem_reference::grid
