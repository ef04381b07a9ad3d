// The grid's tangent and the changes of the cells' unknowns as derivatives of their balanced forces.

#include "cases/mesh/mesh.hpp"
#include "fem_reference/grid/stencil_levels.hpp"

#include <catch2/catch.hpp>
#include <random>

using namespace springproof::fem_reference::grid;

using springproof::cases::index;

namespace grid_tangent {

namespace {

/// A block of 5x4x3 flat cells with two gaps.
Body block(Law law, Internal internal) {
  Body body({5, 4, 3}, Slab(4), {1.1, 0.9, 1.3}, law, internal);
  for (int k = 0; k < 3; ++k)
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 5; ++i) body.weight[index(body.layout.cell(i, j, k))] = 1;
  for (const auto& [i, j, k] : {std::array{2, 1, 1}, std::array{4, 3, 2}})
    body.weight[index(body.layout.cell(i, j, k))] = 0;
  body.parameters = {0.4, 1.1}; // shear and bulk modulus, MPa
  body.n_parameters = 2;
  body.free.setOnes();
  return body;
}

struct State {
  Field<double> displacement;
  std::vector<double> internal;
};

struct Forces {
  Field<double> plain, condensed;
  double bubble_imbalance;
};

Forces forces(const Body& body, const State& state) {
  Forces found{Field<double>::Zero(state.displacement.size()), {}, 0};
  found.condensed = found.plain;
  const ForceFields fields{state.displacement.data(), state.internal.data(), found.plain.data(),
                           found.condensed.data(), nullptr};
  const Cells view = body.view();
  const Checks checks = check_layers(body.slab, 1, [&](int k, Checks& of_layer) {
    kernels().force(view, fields, k, of_layer);
    found.bubble_imbalance += of_layer.bubble_imbalance;
  });
  REQUIRE(checks.valid);
  return found;
}

std::vector<double> change(const Body& body, const State& state, const Field<double>& step) {
  std::vector<double> found(index(body.n_internal()));
  const ForceFields fields{state.displacement.data(), state.internal.data(), nullptr, nullptr, nullptr};
  const Cells view = body.view();
  for (int k = 0; k < body.cells[2]; ++k)
    kernels().internal_change(view, fields, step.data(), found.data(), k);
  return found;
}

void add(std::vector<double>& to, double factor, const std::vector<double>& change) {
  for (std::size_t e = 0; e < to.size(); ++e) to[e] += factor * change[e];
}

/// The state with these displacements whose cells are balanced.
State balanced(const Body& body, const Field<double>& displacement) {
  State state{displacement, std::vector<double>(index(body.n_internal()))};
  const Field<double> none = Field<double>::Zero(displacement.size());
  for (int iteration = 0; iteration < 12; ++iteration) add(state.internal, 1, change(body, state, none));
  return state;
}

Field<double> random(const Body& body, double size, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> number(-size, size);
  Field<double> field = Field<double>::Zero(3 * body.layout.size);
  for (int c = 0; c < 3; ++c)
    for (int k = 0; k <= body.cells[2]; ++k)
      for (int j = 0; j <= body.cells[1]; ++j)
        for (int i = 0; i <= body.cells[0]; ++i)
          if (has_cell(body, i, j, k)) field[body.layout.at(i, j, k, c)] = number(generator);
  return field;
}

double norm(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size())).norm();
}

} // namespace

TEST_CASE("the grid's tangent is the derivative of the balanced force, whatever the law and the element",
          "[verification][kernels]") {
  for (const Law law : {Law::small_strain, Law::saint_venant_kirchhoff, Law::log_strain})
    for (const Internal internal : {Internal::none, Internal::pressure, Internal::bubbles}) {
      if (law == Law::saint_venant_kirchhoff && internal == Internal::pressure) continue;
      CAPTURE(int(law), int(internal));
      const Body body = block(law, internal);
      const State state = balanced(body, random(body, 0.1, 3));
      const Forces found = forces(body, state);
      CHECK(found.bubble_imbalance <= 1e-26 * found.plain.squaredNorm());
      CHECK((found.condensed - found.plain).norm() <= 1e-12 * found.plain.norm());

      Field<double> direction = random(body, 1, 5), product = Field<double>::Zero(direction.size());
      constexpr double step = 1e-5; // mm: differences of forces keep ten digits
      const State before = balanced(body, state.displacement - step * direction),
                  after = balanced(body, state.displacement + step * direction);
      const Field<double> difference = (forces(body, after).plain - forces(body, before).plain) / (2 * step);
      StencilLevels levels(body, 1, {3, 12});
      levels.linearise(state.displacement.data(), state.internal.data());
      levels.product(direction, product, StencilLevels::Rows::all);
      CHECK((product - difference).norm() <= 2e-7 * difference.norm()); // entries in single precision

      std::vector<double> slope = change(body, state, step * direction);
      const double size = norm(slope);
      add(slope, -0.5, after.internal);
      add(slope, 0.5, before.internal);
      CHECK(norm(slope) <= 1e-7 * size);
    }
}

TEST_CASE("a force with the imbalance of the cells' unknowns is the balanced one to second order",
          "[verification][kernels]") {
  for (const Law law : {Law::small_strain, Law::log_strain})
    for (const Internal internal : {Internal::pressure, Internal::bubbles}) {
      CAPTURE(int(law), int(internal));
      const Body body = block(law, internal);
      const State state = balanced(body, random(body, 0.1, 3));
      const Field<double> force = forces(body, state).plain;
      const auto error = [&](double part) {
        State off = state;
        add(off.internal, part, state.internal);
        const Forces found = forces(body, off);
        CHECK((found.plain - force).norm() > 0.1 * part * force.norm());
        return (found.condensed - force).norm() / force.norm();
      };
      if (law == Law::small_strain)
        CHECK(error(1) <= 1e-13);
      else
        CHECK(error(1e-4) <= 1.01e-2 * error(1e-3) + 1e-13);
    }
}

} // namespace grid_tangent
