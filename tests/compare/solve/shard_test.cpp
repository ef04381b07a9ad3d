#include "compare/solve/kept.hpp"

#include "cases/case/error.hpp"
#include "tests/support/temporary_folder.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <numeric>

using namespace springproof;

using Catch::Contains;
using compare::Shard;
using compare::ShardRecord;

namespace {

/// The folders of n finished shards of one command.
struct Finished {
  TemporaryFolder folder;
  std::vector<std::string> folders;
  explicit Finished(int n) {
    for (int s = 1; s <= n; ++s) add(record(s, n));
  }
  Finished(const Finished&) = delete;
  static ShardRecord record(int index, int count) {
    return {{index, count}, {"gate", "a.toml"}, compare::digest_of({})};
  }
  /// @return the folder
  std::string add(const ShardRecord& record) {
    folders.push_back((folder.path / std::to_string(folders.size())).string());
    std::filesystem::create_directory(folders.back());
    compare::write_record(folders.back(), record);
    return folders.back();
  }
  void change(const std::string& from, const std::string& to) const {
    const std::string file = folders.back() + "/shard.json";
    std::string text = content(file);
    const std::size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    std::ofstream(file) << text.replace(at, from.size(), to);
  }
};

} // namespace

TEST_CASE("a shard is I/N with I from 1 to N, and nothing else is") {
  const auto shard = compare::shard_from("2/13");
  REQUIRE(shard);
  CHECK(shard->index == 2);
  CHECK(shard->count == 13);
  for (const char* wrong : {"", "2", "/", "2/", "/2", "0/2", "3/2", "-1/2", "1/0", "1/2 ", " 1/2", "1/2/3",
                            "1.0/2", "1/99999999999999999999", "one/two"}) {
    CAPTURE(wrong);
    CHECK_FALSE(compare::shard_from(wrong));
  }
}

TEST_CASE("every piece of work is one shard's, and none does more than the mean and the largest piece") {
  std::vector<double> costs;
  for (int i = 0; i < 40; ++i) costs.push_back(1 + (i * 37) % 11 * (i % 7 == 0 ? 20. : 1.));
  const double sum = std::accumulate(costs.begin(), costs.end(), 0.),
               largest = *std::max_element(costs.begin(), costs.end());
  for (const int n : {1, 2, 3, 7, 60}) {
    CAPTURE(n);
    const std::vector<int> shard_of = compare::divide(costs, n);
    REQUIRE(shard_of.size() == costs.size());
    CHECK(shard_of == compare::divide(costs, n));
    std::vector<double> load(static_cast<std::size_t>(n));
    for (std::size_t i = 0; i < costs.size(); ++i)
      load.at(static_cast<std::size_t>(shard_of[i] - 1)) += costs[i];
    CHECK(*std::max_element(load.begin(), load.end()) <=
          sum / n + largest); // Graham (1969), of any such list
  }
  CHECK(compare::divide(std::vector<double>{}, 3).empty());
}

TEST_CASE("all shards of one command are read in their order, whatever the order of the folders") {
  Finished finished(3);
  std::reverse(finished.folders.begin(), finished.folders.end());
  const compare::Shards shards = compare::read_shards(finished.folders);
  CHECK(shards.folders ==
        std::vector<std::string>(finished.folders.rbegin(), finished.folders.rend())); // shards 1 to 3
  CHECK(shards.record.command == std::vector<std::string>{"gate", "a.toml"});
  CHECK(compare::answers_of(shards, {}, compare::FileNames::of_cases).empty());
  CHECK_THROWS_WITH(compare::answers_of(shards, {{}}, compare::FileNames::of_cases),
                    Contains("not what they were"));
}

TEST_CASE("a missing shard, one that is there twice, and shards of different wholes are refused with their "
          "folder") {
  Finished finished(3);
  const auto all = finished.folders;
  CHECK_THROWS_WITH(compare::read_shards({all[0], all[2]}), Contains("of 3 shards 2 is missing"));
  CHECK_THROWS_WITH(compare::read_shards({all[1]}), Contains("of 3 shards 1, 3 are missing"));
  CHECK_THROWS_WITH(compare::read_shards({all[0], all[1], all[0]}), Contains(all[0]) && Contains("so is"));
  const std::string none = (finished.folder.path / "none").string();
  CHECK_THROWS_WITH(compare::read_shards({all[0], none}), Contains(none) && Contains("shard.json"));
  ShardRecord other = Finished::record(3, 3);
  const auto refused = [&](const ShardRecord& record, const std::string& why) {
    const std::string folder = finished.add(record);
    CHECK_THROWS_WITH(compare::read_shards({all[0], all[1], folder}), Contains(folder) && Contains(why));
  };
  other.questions = "digest of b";
  refused(other, "other cases");
  other = Finished::record(3, 3);
  other.command.push_back("--set=fem.refine=1");
  refused(other, "--set=fem.refine=1");
  refused(Finished::record(3, 4), "one of 4 shards, not 3");
}

TEST_CASE("shards of another program, and damaged records, are refused") {
  const Finished finished(2);
  CHECK_NOTHROW(compare::read_shards(finished.folders));
  finished.change("\"program\": \"", "\"program\": \"0");
  CHECK_THROWS_WITH(compare::read_shards(finished.folders), Contains("another program"));
  CHECK_THROWS_WITH(compare::read_shards({finished.folders[1], finished.folders[0]}),
                    Contains("another program"));
  finished.change("\"shard\": 2", "\"shard\": 3");
  CHECK_THROWS_WITH(compare::read_shards(finished.folders), Contains("no shard 3 of 2"));
  finished.change("\"shard\": 3", "\"sh\": 3");
  CHECK_THROWS_AS(compare::read_shards(finished.folders), cases::InputError);
  finished.change("{", "");
  CHECK_THROWS_AS(compare::read_shards(finished.folders), cases::InputError);
}

TEST_CASE("a folder that is used again has no record until its shard has finished again") {
  const Finished finished(1);
  compare::remove_record(finished.folders[0]);
  CHECK_THROWS_WITH(compare::read_shards(finished.folders), Contains("not finished"));
}
