#include "cases/mesh/confined.hpp"

#include "tests/support/temporary_folder.hpp"

#include <catch2/catch.hpp>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <functional>
#include <stdexcept>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

using namespace springproof;

using cases::run_confined;

namespace {

constexpr cases::Limits limits{10, 1'000'000'000};

/// What a system call answers in a confined process: "refused", or what it did instead.
std::string attempt(const std::function<int()>& call) {
  return run_confined(
      [&]() -> std::string {
        if (call() >= 0) return "done";
        return errno == EPERM ? "refused" : std::strerror(errno);
      },
      limits);
}

} // namespace

TEST_CASE("a confined function answers any bytes, and reads files") {
  const TemporaryFolder folder;
  const std::string path = folder.write("a", "content"), large(3000000, '\0');
  CHECK(run_confined([&] { return large + "end"; }, limits) == large + "end");
  CHECK(run_confined([] { return std::string(); }, limits).empty());
  const auto read = [&] {
    std::string text;
    std::ifstream(path) >> text;
    return text;
  };
  CHECK(run_confined(read, limits) == "content");
}

TEST_CASE("a confined function changes no file and reaches no program and no network") {
  const TemporaryFolder folder;
  const std::string old = folder.write("old", "as it was"), fresh = (folder.path / "new").string();
  char* const arguments[] = {const_cast<char*>("touch"), const_cast<char*>(fresh.c_str()), nullptr};
  CHECK(attempt([&] { return execve("/usr/bin/touch", arguments, nullptr); }) == "refused");
  CHECK(attempt([&] { return fork(); }) == "refused");
  CHECK(attempt([&] { return open(fresh.c_str(), O_CREAT | O_WRONLY, 0600); }) == "refused");
  CHECK(attempt([&] { return open(fresh.c_str(), O_CREAT | O_RDONLY, 0600); }) == "refused");
  CHECK(attempt([&] { return open(old.c_str(), O_RDWR); }) == "refused");
  CHECK(attempt([&] { return open(old.c_str(), O_TRUNC | O_RDONLY); }) == "refused");
  CHECK(attempt([&] { return truncate(old.c_str(), 0); }) == "refused");
  CHECK(attempt([&] { return rename(old.c_str(), fresh.c_str()); }) == "refused");
  CHECK(attempt([&] { return unlink(old.c_str()); }) == "refused");
  CHECK(attempt([&] { return mkdir(fresh.c_str(), 0700); }) == "refused");
  CHECK(attempt([&] { return chmod(old.c_str(), 0); }) == "refused");
  CHECK(attempt([&] { return symlink(old.c_str(), fresh.c_str()); }) == "refused");
  CHECK(attempt([&] { return socket(AF_INET, SOCK_STREAM, 0); }) == "refused");
  CHECK(attempt([&] { return kill(getppid(), 0); }) == "refused");
  CHECK_FALSE(std::filesystem::exists(fresh));
  CHECK(std::filesystem::file_size(old) == 9);
}

TEST_CASE("a confined function that does not answer is an error with its reason") {
  const auto work = [](void (*end)()) {
    return [end] {
      end();
      return std::string("unreachable");
    };
  };
  CHECK_THROWS_WITH(run_confined(work([] { throw std::runtime_error("a reason"); }), limits), "a reason");
  CHECK_THROWS_WITH(run_confined(work([] { std::exit(0); }), limits), "ended without an answer");
  CHECK_THROWS_WITH(run_confined(work([] { std::abort(); }), limits), Catch::Contains("Aborted"));
  CHECK_THROWS_WITH(run_confined(work([] { std::raise(SIGSEGV); }), limits), Catch::Contains("crashed"));
  CHECK_THROWS_WITH(run_confined(work([] {
                                   for (volatile int i = 0;; i = 1 - i) {
                                   }
                                 }),
                                 {1, 1'000'000'000}),
                    Catch::Contains("longer than 1 s"));
}

TEST_CASE("a confined function that claims more memory than it may have is told so", "[little_memory]") {
  const auto claim = [](std::size_t size) {
    return [size] { return std::to_string(std::vector<char>(size, 'x').size()); };
  };
  CHECK(run_confined(claim(100'000'000), limits) == "100000000");
#ifndef __SANITIZE_ADDRESS__ // which has an address space of its own
  CHECK_THROWS_WITH(run_confined(claim(2'000'000'000), limits), "needs more than 1000 MB of memory");
#endif
}
