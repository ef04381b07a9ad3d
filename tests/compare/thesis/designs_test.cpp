#include "compare/thesis/designs.hpp"

#include <catch2/catch.hpp>

using namespace springproof;

TEST_CASE("the design with the smallest worst error is recommended among those that are stable everywhere") {
  const auto advice = [](double nu, double small, double large, bool is_stable) {
    compare::Advice a;
    a.poissons_ratio = nu;
    a.cube.small = {small, small, 0.0, true};
    a.cube.large = {large, large, 0.0, is_stable};
    return a;
  };
  compare::Advice failed = advice(0.3, 0.1, 0.1, true);
  failed.cube.large.worst.reset();
  std::vector<compare::Advice> all{
      advice(0.3, 3, 9, true),   advice(0.3, 1, 1, false),   failed,
      advice(0.3, 8, 8.5, true), advice(0.45, 20, 30, true), advice(0.49, 1, 1, false)};
  compare::recommend(all);
  std::vector<bool> marked;
  for (const compare::Advice& a : all) marked.push_back(a.is_recommended);
  CHECK(marked == std::vector<bool>{false, false, false, true, true, false});
}
