#include "compare/provenance/call_program.hpp"

#include "tests/support/temporary_folder.hpp"

#include <catch2/catch.hpp>
#include <chrono>
#include <csignal>
#include <functional>
#include <sys/wait.h>
#include <system_error>
#include <thread>

using namespace springproof;

using compare::call_program;
namespace fs = std::filesystem;

namespace {

/// Waits for what has to come sooner or later.
bool comes_true(const std::function<bool()>& condition) {
  for (int n = 0; n < 3000 && !condition(); ++n) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  return condition();
}

/// Another process that does this and then waits to be killed.
pid_t process_that(const std::function<void()>& work) {
  const pid_t process = fork();
  if (process != 0) return process;
  std::signal(SIGTERM, SIG_DFL); // not Catch2's report
  work();
  pause();
  _exit(0);
}

void end(pid_t process, int signal) {
  kill(process, signal);
  waitpid(process, nullptr, 0);
}

} // namespace

TEST_CASE("a program gets its arguments as they are, and its folder and variables") {
  const TemporaryFolder folder;
  const std::string here = fs::canonical(folder.path).string();
  const auto echo = call_program({{"printf", "%s\\n", "'; touch P; $(touch P) `touch P`"}, here, {}});
  REQUIRE(echo);
  CHECK(echo->said == "'; touch P; $(touch P) `touch P`\n");
  CHECK(fs::is_empty(folder.path));
  CHECK(call_program({{"pwd"}, here, {}})->said == here + "\n");
  const auto home = call_program({{"printenv", "HOME"}, here, {"HOME=/nowhere"}});
  CHECK(home->said == "/nowhere\n");
}

TEST_CASE("a program's end is told: its status, its signal, that it is not there, that its folder is not") {
  CHECK(call_program({{"false"}, "/", {}})->status == 1);
  CHECK(call_program({{"sh", "-c", "echo lost >&2; kill -TERM $$"}, "/", {}})->status == 128 + SIGTERM);
  CHECK(call_program({{"sh", "-c", "echo said >&2"}, "/", {}})->said == "said\n");
  CHECK_FALSE(call_program({{"springproof-has-no-such-program"}, "/", {}}));
  CHECK_THROWS_AS(call_program({{"true"}, "/no/such/folder", {}}), std::system_error);
}

TEST_CASE("a program does not outlive the process that called it") {
  const TemporaryFolder folder;
  const fs::path file = folder.path / "process";
  const pid_t caller = process_that([&] {
    call_program(
        {{"sh", "-c", "echo $$ >process.new; mv process.new process; exec sleep 1000"}, folder.path, {}});
  });
  REQUIRE(comes_true([&] { return fs::exists(file); }));
  const int called = std::stoi(content(file));
  end(caller, SIGKILL);
  CHECK(comes_true([&] { return kill(called, 0) != 0; }));
}

TEST_CASE("a folder for temporary files goes with its object, and with a process that is ended") {
  fs::path path;
  {
    const compare::ScratchFolder scratch("test");
    path = scratch.path();
    std::ofstream(path / "file") << "x";
    fs::create_directory(path / "deep");
    CHECK(fs::exists(path / "file"));
  }
  CHECK_FALSE(fs::exists(path));
  for (const int signal : {SIGTERM, SIGKILL}) {
    const TemporaryFolder folder;
    const pid_t owner = process_that([&] {
      const compare::ScratchFolder scratch("test");
      std::ofstream(scratch.path() / "file") << "x";
      fs::create_directory_symlink(scratch.path(), folder.path / "link");
      pause();
    });
    REQUIRE(comes_true([&] { return fs::exists(folder.path / "link"); }));
    end(owner, signal);
    CHECK(comes_true([&] { return !fs::exists(folder.path / "link"); }));
  }
}
