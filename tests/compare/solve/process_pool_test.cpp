#include "compare/solve/process_pool.hpp"

#include <catch2/catch.hpp>
#include <set>
#include <system_error>

using namespace springproof;

namespace {

/// A worker in a few lines of shell: "crash" kills it, "leave" makes it end, "fail" is refused, anything else
/// comes back with the worker's process number behind it.
compare::ProcessPool shell_pool(int n_workers) {
  return {{"sh", "-c",
           "while read -r job; do case $job in crash) kill -SEGV $$;; leave) exit 7;; "
           "fail) printf 'failed 3\\nwhy';; "
           "*) answer=\"$job $$\"; printf 'ok %d\\n%s' ${#answer} \"$answer\";; esac; done"},
          n_workers};
}

std::string first_word(const compare::JobAnswer& answer) {
  REQUIRE(answer.bytes);
  return answer.bytes->substr(0, answer.bytes->find(' '));
}

} // namespace

TEST_CASE("every job is answered once, in its own place, whatever the number of workers") {
  std::vector<std::string> jobs;
  for (int j = 0; j < 20; ++j) jobs.push_back("job" + std::to_string(j));
  for (const int n_workers : {1, 3, 50}) {
    std::multiset<std::size_t> done;
    const auto answers = compare::run_in_processes(
        shell_pool(n_workers), jobs, [&](std::size_t j, const compare::JobAnswer&) { done.insert(j); });
    REQUIRE(answers.size() == jobs.size());
    for (std::size_t j = 0; j < jobs.size(); ++j) {
      CHECK(first_word(answers[j]) == jobs[j]);
      CHECK(done.count(j) == 1);
    }
  }
}

TEST_CASE("a job that fails or crashes its worker fails alone, with the reason, and another worker goes on") {
  const auto answers =
      compare::run_in_processes(shell_pool(1), {"a", "fail", "b", "crash", "c", "leave", "crash", "d"},
                                [](std::size_t, const compare::JobAnswer&) {});
  for (const std::size_t j : {0, 2, 4, 7}) CHECK(answers[j].bytes);
  for (const std::size_t j : {1, 3, 5, 6}) CHECK_FALSE(answers[j].bytes);
  CHECK(answers[1].reason == "why");
  CHECK_THAT(answers[3].reason, Catch::Contains("signal 11"));
  CHECK_THAT(answers[5].reason, Catch::Contains("status 7"));
  CHECK(*answers[0].bytes != *answers[4].bytes);
  CHECK(answers[0].bytes->substr(2) == answers[2].bytes->substr(2)); // the failed job left its worker alive
  CHECK(answers[2].bytes->substr(2) != answers[4].bytes->substr(2)); // the crash did not
}

TEST_CASE("long answers arrive whole") {
  const compare::ProcessPool pool{
      {"sh", "-c", "while read -r n; do printf 'ok %d\\n' $n; head -c $n /dev/zero; done"}, 2};
  const auto answers = compare::run_in_processes(pool, {"1000000", "0", "300000"},
                                                 [](std::size_t, const compare::JobAnswer&) {});
  CHECK(*answers[0].bytes == std::string(1000000, '\0'));
  CHECK(answers[1].bytes->empty());
  CHECK(answers[2].bytes->size() == 300000);
}

TEST_CASE("a worker program that does not exist is an error, no jobs start no worker") {
  const compare::ProcessPool pool{{"/no/such/program"}, 1};
  CHECK_THROWS_AS(compare::run_in_processes(pool, {"a"}, [](std::size_t, const compare::JobAnswer&) {}),
                  std::system_error);
  CHECK(compare::run_in_processes(pool, {}, [](std::size_t, const compare::JobAnswer&) {}).empty());
}
