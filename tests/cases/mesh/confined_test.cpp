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

/// What a system call answers in a confined process: "refused", or what it did instead.
std::string attempt(const std::function<int()>& call) {
  return run_confined(
      [&]() -> std::string {
        if (call() >= 0) return "done";
        return errno == EPERM ? "refused" : std::strerror(errno);
      },
      10);
}

} // namespace

TEST_CASE("a confined function answers any bytes, and reads files") {
  const TemporaryFolder folder;
  const std::string path = folder.write("a", "content"), large(3000000, '\0');
  CHECK(run_confined([&] { return large + "end"; }, 10) == large + "end");
  CHECK(run_confined([] { return std::string(); }, 10).empty());
  const auto read = [&] {
    std::string text;
    std::ifstream(path) >> text;
    return text;
  };
  CHECK(run_confined(read, 10) == "content");
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
  CHECK_THROWS_WITH(run_confined(work([] { throw std::runtime_error("a reason"); }), 10), "a reason");
  CHECK_THROWS_WITH(run_confined(work([] { std::exit(0); }), 10), "ended without an answer");
  CHECK_THROWS_WITH(run_confined(work([] { std::abort(); }), 10), Catch::Contains("Aborted"));
  CHECK_THROWS_WITH(run_confined(work([] { std::raise(SIGSEGV); }), 10), Catch::Contains("crashed"));
  CHECK_THROWS_WITH(run_confined(work([] {
                                   for (volatile int i = 0;; i = 1 - i) {
                                   }
                                 }),
                                 1),
                    Catch::Contains("longer than 1 s"));
}
