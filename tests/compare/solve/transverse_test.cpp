#include "compare/gates/comparison.hpp"
#include "mechanics/elastic_moduli.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

using namespace springproof;

using namespace compare;

/// Bodies of a transversely isotropic material whose moduli a lattice can have, in both models.
namespace {

constexpr double pulled_by = 1e-5; ///< MPa: strains of 1e-4, to which springs are linear

/// C12 - C66 = C13 - C44.
cases::TransverselyIsotropic with_fibre(int axis) {
  auto material = mechanics::engineering_constants({0.15, 0.09, 0.11, 0.4, 0.05, 0.03, 0});
  material.fibre = Eigen::Vector3d::Unit(axis);
  return material;
}

void hold(cases::Case& definition, const std::string& face, const std::array<bool, 3>& components) {
  definition.fixed.push_back({{face}, components});
}

void measure_displacement(cases::Case& definition, const std::string& node, cases::Component component) {
  definition.measures.push_back(
      {node + cases::name_of(component), cases::measures::Displacement{{node}, component}});
}

/// A block under a traction of its top along z, or along x.
cases::Case fibrous_block(const cases::Material& material, const std::array<int, 3>& cells,
                          const Eigen::Vector3d& traction) {
  cases::Case definition;
  definition.name = "block";
  definition.body = cases::Box{{2, 2, 4}, cells};
  definition.material = material;
  definition.loads.push_back({{"z+"}, cases::loads::Traction{traction}});
  definition.fem.formulation = cases::Formulation::small_strain;
  definition.msm.design = cases::Design::transverse;
  return definition;
}

/// Free to slide on its planes of symmetry: it deforms homogeneously.
cases::Case sliding(const cases::Material& material) {
  cases::Case definition = fibrous_block(material, {2, 2, 4}, {0, 0, pulled_by});
  hold(definition, "x-", {true, false, false});
  hold(definition, "y-", {false, true, false});
  hold(definition, "z-", {false, false, true});
  return definition;
}

} // namespace

TEST_CASE("a block that slides on its supports stretches by its Young's modulus along or across the fibre in "
          "both models",
          "[verification]") {
  const int axis = GENERATE(0, 1, 2);
  const cases::TransverselyIsotropic m = with_fibre(axis);
  cases::Case definition = sliding(m);
  measure_displacement(definition, "z+ x+ y+", cases::Component::z);
  measure_displacement(definition, "z+ x+ y+", cases::Component::x);
  measure_displacement(definition, "z- x+ y+", cases::Component::y);
  const double back = m.poissons_ratio_along * m.youngs_modulus_across / m.youngs_modulus_along;
  const double strain = pulled_by / (axis == 2 ? m.youngs_modulus_along : m.youngs_modulus_across);
  const auto ratio = [&](int sideways) {
    return axis == 2 ? m.poissons_ratio_along : axis == sideways ? back : m.poissons_ratio_across;
  };
  const std::array<double, 3> exact{4 * strain, -2 * ratio(0) * strain, -2 * ratio(1) * strain};
  const Comparison comparison = compare_case(definition);
  REQUIRE(comparison.measures.size() == 3);
  for (std::size_t i = 0; i < 3; ++i) {
    CAPTURE(axis, i);
    CHECK(comparison.measures[i].fem.value() == Approx(exact[i]).epsilon(1e-9));
    CHECK(comparison.measures[i].msm.value() == Approx(exact[i]).epsilon(3e-4));
  }
}

TEST_CASE("layers whose fibres stand and lie stretch by the sum of theirs in both models", "[verification]") {
  // Without lateral strains the solution is linear in each layer; a lattice has these moduli.
  const cases::TransverselyIsotropic upright{0.3, 0.1, 0, 0, 0.05, Eigen::Vector3d::UnitZ()};
  cases::TransverselyIsotropic lying = upright;
  lying.fibre = Eigen::Vector3d::UnitX();
  cases::Case definition = sliding(upright);
  const double infinity = std::numeric_limits<double>::infinity();
  definition.region_materials.push_back(
      {lying, "", {-infinity, -infinity, 3}, {infinity, infinity, infinity}, {}});
  measure_displacement(definition, "z+ x+ y+", cases::Component::z);
  const double exact = pulled_by * (3 / 0.3 + 1 / 0.1);
  const Comparison comparison = compare_case(definition);
  REQUIRE(comparison.measures.size() == 1);
  CHECK(comparison.measures[0].fem.value() == Approx(exact).epsilon(1e-9));
  CHECK(comparison.measures[0].msm.value() == Approx(exact).epsilon(3e-4));
}

TEST_CASE("springs of a clamped block approach its finite elements with the mesh, pulled and sheared",
          "[verification]") {
  const int axis = GENERATE(0, 1, 2);
  const bool is_pulled = GENERATE(true, false);
  const Eigen::Vector3d traction =
      is_pulled ? Eigen::Vector3d(0, 0, pulled_by) : Eigen::Vector3d(pulled_by / 4, 0, 0);
  std::array<double, 2> error{};
  for (const int n : {0, 1}) {
    const int along = 4 << n;
    cases::Case definition = fibrous_block(with_fibre(axis), {along, along, 2 * along}, traction);
    hold(definition, "z-", {true, true, true});
    measure_displacement(definition, "z+ x+ y+", is_pulled ? cases::Component::z : cases::Component::x);
    const Comparison comparison = compare_case(definition);
    error[static_cast<std::size_t>(n)] = std::abs(comparison.measures.at(0).error_percent.value());
  }
  CAPTURE(axis, is_pulled, error[0], error[1]);
  CHECK(error[0] <= 8);              // percent, of four cells along an edge
  CHECK(error[1] <= 0.7 * error[0]); // first order or better
}
