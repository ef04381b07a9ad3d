#include "cases/case/input_file.hpp"

#include "cases/case/error.hpp"
#include "tests/support/temporary_folder.hpp"

#include <catch2/catch.hpp>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

using namespace springproof;

using Catch::Contains;
namespace fs = std::filesystem;

// One function opens case files, networks, displacements, curves, recordings, kept results and records of
// shards; meshes, surfaces and pictures are held against is_regular_file() before their confined readers
// begin.
TEST_CASE("a text is read without the mark that some programs put first") {
  const TemporaryFolder folder;
  CHECK(cases::read_text_file(folder.write("bom.csv", "\xef\xbb\xbf"
                                                      "x,y\r\n")) == "x,y\r\n");
  CHECK(cases::read_text_file(folder.write("plain.csv", "x,y\n")) == "x,y\n");
  CHECK(cases::read_text_file(folder.write("empty.csv", "")).empty());
}

TEST_CASE("a text that is none says what it is") {
  const TemporaryFolder folder;
  const std::string little("\xff\xfex\0,\0", 6), big("\xfe\xff\0x\0,", 6), zero("x,\0,y", 5);
  for (const std::string& text : {little, big})
    CHECK_THROWS_WITH(cases::read_text_file(folder.write("a.csv", text)),
                      Contains("a.csv: ") && Contains("UTF-16"));
  CHECK_THROWS_WITH(cases::read_text_file(folder.write("a.csv", zero)), Contains("a byte of zero"));
}

TEST_CASE("what may never end is not read: devices, and pipes in folders") {
  const TemporaryFolder folder;
  const std::string pipe = (folder.path / "pipe.csv").string(), link = (folder.path / "zero.csv").string();
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  fs::create_symlink("/dev/zero", link);
  for (const std::string& path : {pipe, link, std::string("/dev/zero")})
    CHECK_THROWS_WITH(cases::read_bytes(path), Contains(path + ": cannot be read: is no regular file"));
  CHECK_THROWS_WITH(cases::read_bytes(folder.path.string()), Contains("Is a directory"));
  CHECK_THROWS_WITH(cases::read_bytes("/no/such"), "/no/such: cannot be read: No such file or directory");
}

TEST_CASE("a shell's pipe is read to its end, and no file beyond its limit") {
  int ends[2];
  REQUIRE(pipe(ends) == 0);
  REQUIRE(write(ends[1], "abc", 3) == 3);
  close(ends[1]);
  CHECK(cases::read_bytes("/dev/fd/" + std::to_string(ends[0])) == "abc");
  close(ends[0]);
  const TemporaryFolder folder;
  const std::string file = folder.write("a", "abcd");
  CHECK(cases::read_bytes(file, 4) == "abcd");
  CHECK_THROWS_WITH(cases::read_bytes(file, 3), Contains("has 4 bytes or more, may have 3"));
}
