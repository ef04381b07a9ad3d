#include "compare/thesis/entries.hpp"

#include "tests/compare/thesis/table_entry.hpp"

#include <catch2/catch.hpp>

using namespace springproof;

using compare::TableEntry;

TEST_CASE("a printed beta_1 that is the error of 45 deg + beta_2 is marked so, any other as unexplained") {
  std::vector<TableEntry> entries{entry({25, 24}, "beta_1"), entry({25}, "beta_1"), entry({25}, "beta_1"),
                                  entry({25}, "beta_1")};
  entries[0].computed[1].from_beta_2 = 10.06;
  entries[0].computed[1].reference = "small_strain q1_bbar";
  entries[0].computed[0].from_beta_2 = 9.8;
  entries[1].computed[0].from_beta_2 = 9.5;
  entries[1].computed[0].from_printed_beta_2 = 9.98;
  entries[2].computed[0].from_beta_2 = 10.3;
  entries[3].computed[0].from_beta_2 = -10;
  compare::explain(entries);
  CHECK_THAT(entries[0].finding, Catch::Contains("print holds the error of 45 deg + beta_2") &&
                                     Catch::Contains("10.06 with small_strain q1_bbar"));
  CHECK(compare::nearest_from_beta_2(entries[0]).reference == &entries[0].computed[1]);
  CHECK_THAT(entries[1].finding, Catch::Contains("9.98") && Catch::Contains("printed error of beta_2"));
  CHECK_THAT(entries[2].finding, Catch::Contains("perhaps"));
  CHECK_THAT(entries[3].finding, Catch::Contains("nor any other quantity"));
}

TEST_CASE("a large alpha_1 is marked when print lies above the reference that meets alpha_2, and only then") {
  std::vector<TableEntry> entries{entry({4.5, 12}, "alpha_1"), entry({9.8, 3}, "alpha_2")};
  compare::explain(entries);
  CHECK_THAT(entries[0].finding, Catch::Contains("5.5 points above") && Catch::Contains("within 0.2"));
  CHECK(entries[1].finding.empty());
  entries[0].computed[0].value = 14; // print lies below
  compare::explain(entries);
  CHECK(entries[0].finding.empty());
}
