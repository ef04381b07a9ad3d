#include "compare/provenance/whole_file.hpp"

#include "cases/case/error.hpp"
#include "tests/support/temporary_folder.hpp"

#include <catch2/catch.hpp>
#include <sys/stat.h>
#include <sys/wait.h>
#include <thread>

using namespace springproof;

namespace fs = std::filesystem;

namespace {

void write_text(const std::string& path, const std::string& text) {
  compare::write_file(path, [&](std::ostream& out) { out << text; });
}

} // namespace

TEST_CASE("a file is written whole or not at all") {
  const TemporaryFolder folder;
  const std::string target = (folder.path / "deep" / "file.txt").string();
  compare::write_file(target, [](std::ostream& out) { out << "whole"; });
  CHECK_THROWS_AS(compare::write_file(target,
                                      [](std::ostream& out) {
                                        out << "ha";
                                        out.setstate(std::ios::badbit);
                                      }),
                  cases::InputError);
  std::ifstream file(target);
  CHECK(std::string(std::istreambuf_iterator<char>(file), {}) == "whole");
  CHECK(std::distance(fs::directory_iterator(folder.path / "deep"), fs::directory_iterator()) == 1);
  CHECK_THROWS_AS(compare::write_file("/proc/none/file", [](std::ostream&) {}), cases::InputError);
}

TEST_CASE("what a killed run has left of a file is made anew") {
  const TemporaryFolder folder;
  const std::string left = folder.write("file.txt.part", "ha");
  write_text((folder.path / "file.txt").string(), "whole");
  CHECK(compare::read_file((folder.path / "file.txt").string()) == "whole");
  CHECK_FALSE(fs::exists(left));
}

TEST_CASE("a pipe is written to, not replaced") {
  const TemporaryFolder folder;
  const std::string pipe = (folder.path / "pipe").string();
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  std::string received;
  std::thread reader([&] { received = compare::read_file(pipe); });
  write_text(pipe, "through");
  reader.join();
  CHECK(received == "through");
  CHECK(fs::is_fifo(pipe));
}

TEST_CASE("a link is followed, not replaced") {
  const TemporaryFolder folder;
  const std::string file = folder.write("file.txt", "old"), link = (folder.path / "link").string();
  fs::create_symlink(file, link);
  write_text(link, "new");
  CHECK(content(file) == "new");
  CHECK(fs::is_symlink(link));
}

TEST_CASE("a full disk is an error that names the file") {
  const TemporaryFolder folder;
  const std::string link = (folder.path / "link").string(); // were the device replaced, it would be missed
  fs::create_symlink("/dev/full", link);
  CHECK_THROWS_WITH(write_text(link, "text"), Catch::Contains("link': No space left"));
}

TEST_CASE("a folder and a file that is not there cannot be read, an empty file can") {
  const TemporaryFolder folder;
  CHECK_THROWS_AS(compare::read_file(folder.path.string()), cases::InputError);
  CHECK_THROWS_AS(compare::read_file("/no/such/file"), cases::InputError);
  CHECK(compare::read_file(folder.write("empty", "")).empty());
}

TEST_CASE("a folder of results is made, and claimed by one process at a time") {
  const TemporaryFolder folder;
  const std::string out = (folder.path / "deep/out").string();
  if (const pid_t other = fork(); other != 0) {
    int status = 0;
    waitpid(other, &status, 0);
    CHECK(status == 0);
  } else {
    compare::claim_folder(out);
    _exit(0);
  }
  compare::claim_folder(out); // the other process has ended
  CHECK_THROWS_WITH(compare::claim_folder(out), Catch::Contains("another springproof"));
}

TEST_CASE("a folder of results that cannot be made is refused") {
  const TemporaryFolder folder;
  CHECK_THROWS_AS(compare::claim_folder(folder.write("file", "in the way") + "/out"), cases::InputError);
  CHECK_THROWS_AS(compare::claim_folder("/proc/none"), cases::InputError);
  CHECK_NOTHROW(compare::claim_folder(""));
}
