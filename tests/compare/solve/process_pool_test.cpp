#include "compare/solve/process_pool.hpp"

#include <catch2/catch.hpp>
#include <set>
#include <system_error>

using namespace springproof;

namespace {

/// A worker in a few lines of Python: "crash" kills it, "leave" makes it end, "fail" is refused, "chatter"
/// comes back as no message, "zeros N" as N zeros, anything else with the worker's process number behind it.
const std::vector<std::string> worker{"python3", "-c", R"(
import os, signal, sys
def answer(kind, content):
    sys.stdout.buffer.write(b"%b %d\n" % (kind, len(content)) + content)
    sys.stdout.buffer.flush()
while heading := sys.stdin.buffer.readline():
    kind, size = heading.split()
    job = sys.stdin.buffer.read(int(size))
    assert kind == b"job"
    if job == b"crash": os.kill(os.getpid(), signal.SIGSEGV)
    elif job == b"leave": sys.exit(7)
    elif job == b"fail": answer(b"failed", b"why")
    elif job == b"chatter": print("x" * 200, flush=True)
    elif job.startswith(b"zeros "): answer(b"ok", bytes(int(job.split()[1])))
    else: answer(b"ok", job + b" %d" % os.getpid())
)"};

std::vector<compare::JobAnswer> run(int n_workers, const std::vector<std::string>& jobs,
                                    const std::vector<std::string>& by = worker) {
  return compare::run_in_processes(
      by, n_workers, jobs.size(), [&](std::size_t j) { return jobs[j]; },
      [](std::size_t, const compare::JobAnswer&) {});
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
        worker, n_workers, jobs.size(), [&](std::size_t j) { return jobs[j]; },
        [&](std::size_t j, const compare::JobAnswer&) { done.insert(j); });
    REQUIRE(answers.size() == jobs.size());
    for (std::size_t j = 0; j < jobs.size(); ++j) {
      CHECK(first_word(answers[j]) == jobs[j]);
      CHECK(done.count(j) == 1);
    }
  }
}

TEST_CASE("a job that fails or crashes its worker fails alone, with the reason, and another worker goes on") {
  const auto answers = run(1, {"a", "fail", "b", "crash", "c", "leave", "crash", "d"});
  for (const std::size_t j : {0, 2, 4, 7}) CHECK(answers[j].bytes);
  for (const std::size_t j : {1, 3, 5, 6}) CHECK_FALSE(answers[j].bytes);
  CHECK(answers[1].reason == "why");
  CHECK_THAT(answers[3].reason, Catch::Contains("signal 11"));
  CHECK_THAT(answers[5].reason, Catch::Contains("status 7"));
  CHECK(*answers[0].bytes != *answers[4].bytes);
  CHECK(answers[0].bytes->substr(2) == answers[2].bytes->substr(2)); // the failed job left its worker alive
  CHECK(answers[2].bytes->substr(2) != answers[4].bytes->substr(2)); // the crash did not
}

TEST_CASE("a job may hold any bytes") {
  const std::string job{"\0\n\t\xff job 3 x\n", 14};
  CHECK(run(1, {job})[0].bytes->substr(0, job.size()) == job);
}

TEST_CASE("an answer that is no message fails its job, and another worker goes on") {
  const auto answers = run(1, {"chatter", "a"});
  CHECK_THAT(answers[0].reason, Catch::Contains("no message"));
  CHECK(answers[1].bytes);
}

TEST_CASE("long answers arrive whole") {
  const auto answers = run(2, {"zeros 1000000", "zeros 0", "zeros 300000"});
  CHECK(*answers[0].bytes == std::string(1000000, '\0'));
  CHECK(answers[1].bytes->empty());
  CHECK(answers[2].bytes->size() == 300000);
}

TEST_CASE("a worker program that does not exist is an error, no jobs start no worker") {
  CHECK_THROWS_AS(run(1, {"a"}, {"/no/such/program"}), std::system_error);
  CHECK(run(1, {}, {"/no/such/program"}).empty());
}
