#include "compare/thesis/published.hpp"

#include "tests/support/temporary_folder.hpp"

#include <catch2/catch.hpp>
#include <fstream>

using namespace springproof;

TEST_CASE("the published figures are read whole, and a broken row is named") {
  // three stiffnesses for eleven nu; 6 + 9 eigenvalues and their multiplicities; eleven h;
  // six measures in the columns of 4.5, 4.6, 4.7, 5.1, 5.3, 5.4; six volumes; three bars
  CHECK(compare::published_figures().size() ==
        3 * 11 + 2 * (6 + 9) + 11 + 6 * (5 + 5 + 2 + 2 + 2 + 2) + 6 + 3);
  const TemporaryFolder folder;
  const std::string path = (folder.path / "broken.csv").string();
  std::ofstream(path) << "a,b\n1,2\n1\n";
  CHECK_THROWS_WITH(compare::read_csv(path), Catch::Contains("broken.csv:3") && Catch::Contains("1 fields"));
}

TEST_CASE("stiffnesses that the thesis prints are found, others are not made up") {
  CHECK(*compare::published_stiffness("linear_method", "linear_elastic", 0.35) ==
        std::array<double, 3>{31, 47, 33});
  CHECK(*compare::published_stiffness("nonlinear_method", "ogden", 0.5) == std::array<double, 3>{14, 17, 63});
  CHECK_FALSE(compare::published_stiffness("linear_method", "linear_elastic", 0.3));
}
