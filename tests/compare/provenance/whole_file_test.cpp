#include "compare/provenance/whole_file.hpp"

#include "cases/case/error.hpp"
#include "tests/support/temporary_folder.hpp"

#include <algorithm>
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

/// Writes to a path given on the command line.
void write_named_text(const std::string& path, const std::string& text) {
  compare::write_named_file(path, [&](std::ostream& out) { out << text; });
}

std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename());
  std::sort(names.begin(), names.end());
  return names;
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
  const std::string left = folder.write("file.txt" + compare::unfinished, "ha");
  write_text((folder.path / "file.txt").string(), "whole");
  CHECK(compare::read_file((folder.path / "file.txt").string()) == "whole");
  CHECK_FALSE(fs::exists(left));
}

TEST_CASE("a file that is written anew keeps its mode and its owner") {
  const TemporaryFolder folder;
  const std::string file = folder.write("file.txt", "old");
  REQUIRE(chmod(file.c_str(), 0640) == 0);
  const bool is_root = geteuid() == 0;
  if (is_root) REQUIRE(chown(file.c_str(), 1234, 1235) == 0);
  write_text(file, "new");
  CHECK(content(file) == "new");
  struct stat now {};
  REQUIRE(stat(file.c_str(), &now) == 0);
  CHECK((now.st_mode & 07777) == 0640);
  if (is_root) CHECK((now.st_uid == 1234 && now.st_gid == 1235));
}

TEST_CASE("in a folder of results a link is replaced, and what it leads to stays as it is") {
  const TemporaryFolder folder;
  const std::string file = folder.write("elsewhere", "old"), link = (folder.path / "results.json").string();
  for (const std::string& place : {link, link + compare::unfinished}) {
    fs::create_symlink(file, place);
    write_text(link, "new");
    CHECK(content(file) == "old");
    CHECK(fs::is_regular_file(fs::symlink_status(link)));
    CHECK(content(link) == "new");
    fs::remove(link);
  }
}

TEST_CASE("a pipe is written to, not replaced") {
  const TemporaryFolder folder;
  const std::string pipe = (folder.path / "pipe").string();
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  std::string received;
  std::thread reader([&] { received = content(pipe); });
  write_named_text(pipe, "through");
  reader.join();
  CHECK(received == "through");
  CHECK(fs::is_fifo(pipe));
}

TEST_CASE("a link is followed, not replaced") {
  const TemporaryFolder folder;
  const std::string file = folder.write("file.txt", "old"), link = (folder.path / "link").string();
  fs::create_symlink(file, link);
  write_named_text(link, "new");
  CHECK(content(file) == "new");
  CHECK(fs::is_symlink(link));
}

TEST_CASE("a full disk is an error that names the file") {
  const TemporaryFolder folder;
  const std::string link = (folder.path / "link").string(); // were the device replaced, it would be missed
  fs::create_symlink("/dev/full", link);
  CHECK_THROWS_WITH(write_named_text(link, "text"), Catch::Contains("link': No space left"));
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

TEST_CASE("what killed runs have left unfinished in a folder of results is removed, and nothing else") {
  const TemporaryFolder folder;
  const std::string left = "mesh-1" + compare::unfinished;
  fs::create_directories(folder.path / "solved");
  for (const std::string& name :
       {left, "solved/" + left, std::string("film.part"), std::string("results.json")})
    folder.write(name, "ha");
  compare::claim_folder(folder.path);
  CHECK(names_in(folder.path) == std::vector<std::string>{"film.part", "results.json", "solved"});
  CHECK(names_in(folder.path / "solved") == std::vector<std::string>{left});
  compare::claim_subfolder(folder.path, "solved");
  CHECK(names_in(folder.path / "solved").empty());
}

TEST_CASE("a folder within that of the results is no link to another one") {
  const TemporaryFolder folder, elsewhere;
  fs::create_directory_symlink(elsewhere.path, folder.path / "solved");
  CHECK_THROWS_AS(compare::claim_subfolder(folder.path, "solved"), cases::InputError);
  CHECK(fs::is_empty(elsewhere.path));
}

TEST_CASE("a file of the command line that cannot be written is found before there is anything to write") {
  const TemporaryFolder folder;
  const std::string file = folder.write("file", "old");
  CHECK_NOTHROW(compare::check_named_file(""));
  CHECK_NOTHROW(compare::check_named_file("/dev/null"));
  CHECK_NOTHROW(compare::check_named_file(file));
  CHECK_NOTHROW(compare::check_named_file(folder.path / "deep/new"));
  CHECK(content(file) == "old");
  CHECK(names_in(folder.path) == std::vector<std::string>{"deep", "file"});
  CHECK(fs::is_empty(folder.path / "deep"));
  CHECK_THROWS_WITH(compare::check_named_file(folder.path / "deep"), Catch::Contains("directory"));
  CHECK_THROWS_AS(compare::check_named_file(file + "/below"), cases::InputError);
  CHECK_THROWS_AS(compare::check_named_file("/proc/none"), cases::InputError);
}

TEST_CASE("a folder of results that cannot be made is refused") {
  const TemporaryFolder folder;
  CHECK_THROWS_AS(compare::claim_folder(folder.write("file", "in the way") + "/out"), cases::InputError);
  CHECK_THROWS_AS(compare::claim_folder("/proc/none"), cases::InputError);
  CHECK_NOTHROW(compare::claim_folder(""));
  CHECK_NOTHROW(compare::claim_subfolder("", "solved"));
}
