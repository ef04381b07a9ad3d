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
  /// @param scene   with the mesh of the elements
  /// @param places  of the body, which must outlive this
  Inertia(const cases::Scene& scene, const Places& places, int n_threads);

  /// mass M + damping C: 1/s², 1/s.
  struct Factors {
    double mass = 0, damping = 0;
  };
  /// product += (mass M + damping C) field, on all entries; the field's ghosts are current.
  void add_product(const Factors& factors, const Field<double>& field, Field<double>& product);

  /// Of a step in time, for its residuals and its tangent.
  /// @return whether these are other factors than before
  bool set_step(const Factors& factors);
  void add_step_product(const Field<double>& field, Field<double>& product) {
    add_product(step_, field, product);
  }
  Masses step_masses() const; ///< of the cells; points into this
  const Field<double>& step_node_masses() const { return step_node_masses_; } ///< of [[mass]]; empty: none
  /// A linear body whose tangent is the part of K(rest) in the matrix; nothing where there is none.
  std::optional<Cells> step_damping() const;

 private:
  const Body& body_;
  int n_threads_;
  bool is_lumped_;
  std::vector<double> mass_of_cell_, damped_mass_of_cell_; ///< t, t/s
  Field<double> node_mass_;                                ///< t
  std::unique_ptr<Body> damping_body_; ///< of moduli times stiffness_damping, N s/mm²; none: no such damping
  Factors step_;
  std::vector<double> step_masses_, factored_; ///< t/s²: of the step, and of the last product
  Field<double> step_node_masses_;
  Field<double> force_, pressed_; ///< of the damping body

  void factor(const Factors& factors, std::vector<double>& masses) const;
  Masses in_parts(const std::vector<double>& masses) const;
  Cells damping_view(double factor) const;
  void make_damping_body(const cases::Scene& scene, const Places& places);
};

} // namespace springproof::fem_reference::grid
