#include "compare/thesis/sheet.hpp"

#include <catch2/catch.hpp>

using namespace springproof;

namespace {

compare::TableEntry entry(const std::string& table, double poissons_ratio, const std::string& measure) {
  return {{table, "linear_elastic", poissons_ratio, "linear_method", poissons_ratio, "small", "shear",
           measure, "%", 0},
          {{}},
          ""};
}

} // namespace

TEST_CASE("entries become tables in the order of print, and each has its place") {
  const std::vector<compare::TableEntry> entries{entry("4.5", 0.2, "alpha_1"), entry("4.5", 0.25, "alpha_1"),
                                                 entry("4.6", 0.2, "alpha_1"), entry("4.5", 0.25, "alpha_2")};
  const std::vector<compare::Sheet> sheets = compare::sheets_of(entries);
  REQUIRE(sheets.size() == 2);
  CHECK(name_of(sheets[0]) == "Table 4.5");
  REQUIRE(sheets[0].rows.size() == 2);
  REQUIRE(sheets[0].columns.size() == 2);
  CHECK(sheets[0].find(0, 1) == &entries[1]);
  CHECK(sheets[0].find(1, 1) == &entries[3]);
  CHECK(sheets[0].find(1, 0) == nullptr); // print has no such figure
  CHECK(sheets[0].first_of_row(1) == &entries[3]);
  CHECK(sheets[1].find(0, 0) == &entries[2]);
}
