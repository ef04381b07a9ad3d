#include "msm/grid/held_factor.hpp"

#include "msm/grid/spring_field.hpp"

#include <catch2/catch.hpp>

using namespace springproof;

using msm::grid::Body;
using msm::grid::Field;

namespace held_factors {

namespace {

/// A body with a gap and cells of two stiffnesses, held at x = 0.
Body body_with_gap() {
  Body body;
  body.cells = {7, 5, 6};
  body.spacing = {1, 1.2, 0.9};
  msm::grid::for_each_place(body.cells, [&](int i, int j, int k) {
    body.springs.emplace_back();
    if (i > 2 && k == 3) return;
    const double k_s = j < 2 ? 0.03 : 0.3;
    body.springs.back() = {{k_s, k_s, k_s}, {1.5 * k_s, 1.5 * k_s, 1.5 * k_s}, k_s, k_s};
  });
  set_layout(body, [](int i, int, int, int) { return i == 0; });
  return body;
}

Field<double> any(const Body& body, unsigned seed) {
  return msm::grid::random_field<double>(body, seed, std::normal_distribution<double>());
}

} // namespace

TEST_CASE("a held factor undoes the operator that it was made of") {
  const Body body = body_with_gap();
  const msm::grid::SpringField<double> springs(body, 1);
  const Field<double> at = 0.1 * any(body, 1), mass = 0.01 * any(body, 2).cwiseAbs();
  const auto vectors = msm::grid::NodeVectors::fields(body);
  msm::grid::HeldFactor factor(body, vectors);
  const auto operate = [&](double sign) {
    return [&, sign](const Field<double>& v, Field<double>& product) {
      if (product.size() != v.size()) product.setZero(v.size());
      springs.product(msm::Clamp::yes, at, v, product);
      product = sign * (product + mass.cwiseProduct(v));
    };
  };
  CHECK_FALSE(factor.factorise(operate(-1)));
  REQUIRE(factor.factorise([&](const Field<double>& v, Field<double>& product) { product = v; }));
  REQUIRE(factor.factorise(operate(1))); // anew
  const Field<double> motion = any(body, 3);
  Field<double> force, found;
  for (const double size : {1e-30, 1.0, 1e30}) { // 16 bits of a column's largest inside
    operate(1)(size * motion, force);
    factor.apply(force, found);
    CHECK((found - size * motion).norm() <= 1e-3 * size * motion.norm());
  }
  factor.apply(Field<double>::Zero(motion.size()), found);
  CHECK(found.isZero(0));
}

} // namespace held_factors
