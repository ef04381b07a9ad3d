#include "cases/case/names.hpp"

#include "cases/case/case.hpp"
#include "cases/case/solution.hpp"

#include <catch2/catch.hpp>

using namespace springproof;

using namespace cases;

namespace {

/// The names of an enumeration whose enumerators are 0, 1, ... n - 1: each has one, and it leads back.
template<class Enum>
void check_names(int n) {
  CHECK(all_names<Enum>().size() == static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i) {
    const Enum value = static_cast<Enum>(i);
    CHECK(name_of(value) != "?");
    CHECK(value_of<Enum>(name_of(value)) == value);
  }
  CHECK_FALSE(value_of<Enum>("?").has_value());
}

template<class Variant>
void check_kinds(std::size_t n) {
  CHECK(Kinds<Variant>::names().size() == n);
  for (const std::string& name : Kinds<Variant>::names()) CHECK(name_of(Kinds<Variant>::named(name)) == name);
}

} // namespace

TEST_CASE("every enumerator has one name, and the name leads back to it") {
  check_kinds<loads::Kind>(5);
  check_names<Scheme>(4);
  check_names<MotionStart>(2);
  check_names<ElementMass>(2);
  check_names<PointMass>(3);
  check_names<OverTime>(8);
  check_names<Formulation>(4);
  check_names<Element>(10);
  check_names<Design>(16);
  check_kinds<measures::Kind>(16);
  check_kinds<tools::Kind>(5);
  check_names<Statistic>(3);
  check_names<Axis>(3);
  check_names<Frame>(2);
  check_names<Component>(4);
  check_names<TensorComponent>(10);
  check_names<ReferenceKind>(6);
  check_names<Quantity>(3);
  check_names<Status>(3);
  check_names<Outcome>(6);
  check_names<Solver>(5);
  check_names<Side>(2);
  check_names<Start>(3);
}

TEST_CASE("the nearest name is few edits away, or there is none") {
  const std::vector<std::string> known{"region", "kind", "value", "youngs_modulus", "x"};
  CHECK(nearest_name("regoin", known) == "region");
  CHECK(nearest_name("vlaue", known) == "value");
  CHECK(nearest_name("youngsmodulus", known) == "youngs_modulus");
  CHECK(nearest_name("kinds", known) == "kind");
  CHECK_FALSE(nearest_name("y", known).has_value());
  CHECK_FALSE(nearest_name("poissons_ratio", known).has_value());
  CHECK_FALSE(nearest_name("", known).has_value());
}
