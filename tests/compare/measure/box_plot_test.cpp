#include "compare/measure/box_plot.hpp"

#include <catch2/catch.hpp>

using namespace springproof;

TEST_CASE("the box of eight values has its quartiles half-way between values, and no outliers") {
  const compare::BoxPlot box = compare::box_plot({8, 3, 1, 6, 2, 5, 7, 4});
  CHECK(box.lower_quartile == 2.5); // position 0.25 x 8 + 1/2
  CHECK(box.median == 4.5);
  CHECK(box.upper_quartile == 6.5);
  CHECK(box.lower_whisker == 1);
  CHECK(box.upper_whisker == 8);
  CHECK(box.outliers.empty());
}

TEST_CASE("a value beyond 1.5 times the interquartile range is an outlier, one just at it is not") {
  // Quartiles 2.75 and 7.25: the whiskers reach from -4 to 14.
  const compare::BoxPlot far = compare::box_plot({1, 2, 3, 4, 5, 6, 7, 8, 14.001});
  CHECK(far.upper_quartile == 7.25);
  CHECK(far.upper_whisker == 8);
  CHECK(far.outliers == std::vector<double>{14.001});
  const compare::BoxPlot near = compare::box_plot({1, 2, 3, 4, 5, 6, 7, 8, 14});
  CHECK(near.upper_whisker == 14);
  CHECK(near.outliers.empty());
}

TEST_CASE("outliers on both sides are listed in ascending order") {
  const compare::BoxPlot box = compare::box_plot({50, 1, 2, 3, 4, 5, 6, 7, 8, -60, -50});
  CHECK(box.outliers == std::vector<double>{-60, -50, 50});
  CHECK(box.lower_whisker == 1);
  CHECK(box.upper_whisker == 8);
}

TEST_CASE("a single value is its own box, and so are equal ones") {
  for (const std::vector<double>& values : {std::vector<double>{3}, std::vector<double>{3, 3, 3, 3}}) {
    const compare::BoxPlot box = compare::box_plot(values);
    for (const double figure :
         {box.lower_quartile, box.median, box.upper_quartile, box.lower_whisker, box.upper_whisker})
      CHECK(figure == 3);
    CHECK(box.outliers.empty());
  }
}
