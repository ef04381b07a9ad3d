#include "compare/gates/comparison.hpp"
#include "compare/solve/springs.hpp"

#include <catch2/catch.hpp>
#include <limits>

using namespace springproof;

using namespace compare;

namespace {

/// A column of two layers, free to slide at its sides, under a traction: it stretches by sum sigma h_i/E_i.
cases::Case column(double lower_modulus, double upper_modulus) {
  cases::Case definition;
  definition.name = "column";
  definition.body = cases::Box{{2, 2, 4}, {2, 2, 4}};
  definition.material = cases::LinearElastic{lower_modulus, 0};
  const double infinity = std::numeric_limits<double>::infinity();
  definition.region_materials.push_back({cases::LinearElastic{upper_modulus, 0},
                                         "",
                                         {-infinity, -infinity, 3},
                                         {infinity, infinity, infinity},
                                         {}});
  for (const char* face : {"x-", "y-", "z-"}) {
    cases::Fixed fixed{{face, std::nullopt, {}}, {face[0] == 'x', face[0] == 'y', face[0] == 'z'}};
    definition.symmetry.push_back(fixed);
  }
  definition.loads.push_back({{"z+"}, cases::loads::Traction{{0, 0, 1e-4}}});
  definition.fem.formulation = cases::Formulation::small_strain;
  definition.fem.element = cases::Element::q1;
  definition.msm.design = cases::Design::moduli;
  for (const auto& [name, node] : {std::pair("whole", "z+ x+ y+"), std::pair("whole_too", "z+ x- y-")}) {
    definition.measures.push_back({name, cases::measures::Displacement{{node}, cases::Component::z}});
  }
  return definition;
}

} // namespace

TEST_CASE("layers in a row stretch by the sum of theirs, in finite elements refined or not",
          "[verification]") {
  const double exact = 1e-4 * (3 / 0.2 + 1 / 0.8);
  cases::Case definition = column(0.2, 0.8);
  for (const int refine : {0, 1}) {
    definition.fem.refine = refine;
    const Comparison comparison = compare_case(definition, {cases::Side::fem});
    // Without lateral strains the solution is linear in each layer, which the elements have exactly.
    REQUIRE(comparison.measures.size() == 2);
    for (const MeasuredValue& value : comparison.measures)
      CHECK(value.fem.value() == Approx(exact).epsilon(1e-9));
  }
}

TEST_CASE("springs know the layers' materials: twice as stiff above is half the stretch above",
          "[verification]") {
  const auto stretch = [](double lower, double upper) {
    return compare_case(column(lower, upper), {cases::Side::msm}).measures[0].msm.value();
  };
  // A lattice of springs cannot have nu = 0, and the layers hinder each other's lateral strain; but scaled
  // together they stay in proportion, and a much stiffer layer adds almost nothing.
  CHECK(stretch(0.4, 1.6) ==
        Approx(stretch(0.2, 0.8) / 2).epsilon(1e-3)); // strains of 1e-3 are not quite linear
  CHECK(stretch(0.2, 0.8) < stretch(0.2, 0.2));
  CHECK(stretch(0.2, 20) < stretch(0.2, 0.8));
  CHECK(stretch(0.2, 20) >
        0.7 * stretch(0.2, 0.2)); // three of four cells are as before, hindered at one side
}

TEST_CASE(
    "a ranking gives midlines the law that a case file gives them: Hooke's in layers of two exponents") {
  cases::Case two = column(1, 2);
  two.material = cases::LinearElastic{1, 0.3};
  two.region_materials.front().material = cases::LinearElastic{2, 0.4};
  const auto law = [](const cases::Case& definition) {
    const cases::Scene scene = with_design(cases::make_scene(definition), cases::Design::midline);
    return design_for(scene).stiffness.exponents;
  };
  CHECK_FALSE(law(two));
  two.region_materials.front().material = cases::LinearElastic{2, 0.3};
  CHECK(law(two));
}
