#include "compare/thesis/regenerate.hpp"

#include "tests/support/temporary_folder.hpp"

#include <catch2/catch.hpp>
#include <fstream>
#include <limits>

using namespace springproof;
using compare::SummaryGroup;
using compare::TableEntry;

namespace {

/// An entry of table 4.6 that print gives as 10 %, with a value for each reference.
TableEntry entry(const std::vector<std::optional<double>>& values, const std::string& measure = "alpha_2") {
  TableEntry result{
      {"4.6", "linear_elastic", 0.3, "linear_method", 0.3, "large", "shear", measure, "%", 10}, {}, ""};
  for (const auto& value : values) result.computed.push_back({"log_strain q1_bbar", value});
  return result;
}

const compare::Within& within(const SummaryGroup& group, double bound) {
  for (const compare::Within& w : group.within)
    if (w.bound == bound) return w;
  FAIL("no bound " << bound);
  return group.within.front();
}

void check(const compare::Within& counted, int declared, int other_only, int neither) {
  CHECK(counted.declared == declared);
  CHECK(counted.other_only == other_only);
  CHECK(counted.neither == neither);
}

} // namespace

TEST_CASE("an entry counts for the declared reference, for the other only, or for neither, at each bound") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<TableEntry> entries{entry({10.05, 99}),         // declared within 0.1
                                        entry({10.4, 10.05}),       // declared within 0.5, other within 0.1
                                        entry({-10, 10.9}),         // other alone within 1
                                        entry({12.5, 7}),           // neither, from either side
                                        entry({std::nullopt, 9.8}), // declared failed
                                        entry({std::nullopt, std::nullopt}),
                                        entry({nan, nan})};
  const auto groups = compare::summarise(entries);
  REQUIRE(groups.size() == 1);
  CHECK(groups[0].n_entries == 7);
  check(within(groups[0], 0.1), 1, 1, 5);
  check(within(groups[0], 0.5), 2, 1, 4);
  check(within(groups[0], 1), 2, 2, 3);
  check(within(groups[0], 2), 2, 2, 3);
  CHECK(groups[0].beyond == std::vector<const TableEntry*>{&entries[3], &entries[5], &entries[6]});
}

TEST_CASE("beta_1 is counted apart") {
  const auto groups = compare::summarise({entry({10}), entry({30}, "beta_1")});
  REQUIRE(groups.size() == 2);
  CHECK(groups[0].n_entries == 1);
  CHECK(groups[1].n_entries == 1);
  CHECK(groups[1].beyond.size() == 1);
}

TEST_CASE("a difference that is the bound in decimals is within it") {
  TableEntry exact = entry({1.3});
  exact.published.value = 1.2; // 1.3 - 1.2 is a little more than 0.1 in binary
  check(within(compare::summarise({exact})[0], 0.1), 1, 0, 0);
}

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
