#include "compare/thesis/summary.hpp"

#include "tests/compare/thesis/table_entry.hpp"

#include <catch2/catch.hpp>
#include <limits>

using namespace springproof;

using compare::SummaryGroup;
using compare::TableEntry;

namespace {

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
