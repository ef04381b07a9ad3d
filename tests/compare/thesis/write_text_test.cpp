#include "compare/thesis/write_text.hpp"

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
                                                 entry("4.5", 0.25, "alpha_2"), entry("4.6", 0.2, "alpha_1")};
  const std::vector<compare::Sheet> sheets = compare::sheets_of(entries);
  REQUIRE(sheets.size() == 2);
  CHECK(name_of(sheets[0]) == "Table 4.5");
  REQUIRE(sheets[0].rows.size() == 2);
  REQUIRE(sheets[0].columns.size() == 2);
  CHECK(sheets[0].rows[0].cells == std::vector{&entries[0], &entries[1]});
  CHECK(sheets[0].rows[1].cells ==
        std::vector<const compare::TableEntry*>{nullptr, &entries[2]}); // not printed
  CHECK(sheets[0].rows[1].first == &entries[2]);
  CHECK(sheets[1].rows[0].cells == std::vector{&entries[3]});
}
