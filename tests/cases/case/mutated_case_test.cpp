// Damaged case files. tests/sanitize runs this under the sanitizers; tests/fuzz looks for more than 60
// seconds.

#include "cases/case/read_case.hpp"
#include "tests/fuzz/mutate.hpp"
#include "tests/support/case_text.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

using namespace springproof;

using namespace cases;
namespace fs = std::filesystem;

namespace {

std::vector<std::string> case_files() {
  std::vector<std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(std::string(SPRINGPROOF_SOURCE_DIR) + "/cases"))
    if (entry.path().extension() == ".toml") files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  return files;
}

bool is_hard(const std::string& path) {
  return path.find("/hard/") != std::string::npos;
}

} // namespace

TEST_CASE("300 damaged case files each end in a case or in one line that says what is wrong") {
  const TemporaryFolder folder;
  const std::vector<std::string> files = case_files();
  REQUIRE(files.size() > 20);
  fuzz::Random random(20261121);
  int n_refused = 0, n_read = 0;
  for (int i = 0; i < 300; ++i) {
    const std::string& original = files[fuzz::any_of(files.size(), random)];
    const std::string text = fuzz::mutated(content(original), random);
    INFO(original << " as number " << i << ":\n" << text);
    try {
      if (is_hard(original))
        read_hard_case(folder.write("case.toml", text));
      else
        read_case_text(text, original);
      ++n_read;
    } catch (const InputError& error) {
      ++n_refused;
      const std::string message = error.what();
      CHECK_FALSE(message.empty());
      CHECK(message.find('\n') == std::string::npos);
    } // anything else fails the test
  }
  // A dropped comment or a doubled blank is no mistake, but most of this is.
  CHECK(n_refused > 150);
  CHECK(n_read > 10);
}
