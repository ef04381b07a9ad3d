#pragma once

#include "cases/case/read_case.hpp"
#include "tests/support/temporary_folder.hpp"

#include <catch2/catch.hpp>
#include <string>
#include <vector>

using namespace springproof;

/// Case files with one thing changed, for tests of their readers.
namespace case_text {

using cases::InputError;

inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

struct Mistake {
  std::string from, to; ///< in the good file
  int line;             ///< 0: not asked
  std::string key;
  std::vector<std::string> says;
};

/// Requires that a reader refuses the text where the mistake is, with a message that says what is asked for.
template<class Reader>
void check_refused(const std::string& text, const Mistake& mistake, const Reader& read) {
  const TemporaryFolder folder;
  const std::string path = folder.write("case.toml", text);
  INFO("replaced: " << mistake.from << "\nby: " << mistake.to);
  try {
    read(path);
    FAIL("accepted");
  } catch (const InputError& error) {
    const std::string message = error.what();
    INFO(message);
    CHECK(error.where().file == path);
    CHECK(error.where().key == mistake.key);
    CHECK(error.where().line == mistake.line);
    const std::string begin =
        path + ":" + std::to_string(mistake.line) + ":" + std::to_string(error.where().column) + ": ";
    CHECK(message.rfind(begin + (mistake.key.empty() ? "" : mistake.key + ": "), 0) == 0);
    CHECK(error.where().column >= 1);
    for (const std::string& part : mistake.says) CHECK_THAT(message, Catch::Contains(part));
    CHECK(message.find('\n') == std::string::npos);
  }
}

/// A complete case file, for tests to change. Line numbers matter: `schema` is on line 1.
inline const std::string good_case = R"(schema = 1
name = 'cube-shear-small'
description = 'Shear of the cube.'
[body]
shape = 'box'
size = [10.0, 10.0, 10]
cells = [10, 10, 10]
[material]
model = 'linear_elastic'
youngs_modulus = 0.3
poissons_ratio = 0.35
[[fixed]]
region = 'z-'
[[load]]
region = 'z+'
kind = 'nodal_force'
value = [0.002, 0, 0.0]
[fem]
formulation = 'log_strain'
element = 'q1_bbar'
refine = 1
[msm]
design = 'moduli'
poissons_ratio = 0.3
split = 0.8
[[measure]]
name = 'alpha_1'
kind = 'tilt'
top = 'z+ x- y-'
bottom = 'z- x- y-'
toward = 'x'
[[expect]]
measure = 'alpha_1'
error_percent = [-8.0, 0.0]
reference = 'published'
reason = 'Table 4.5'
)";

inline cases::Case read_text(const std::string& text, const std::vector<std::string>& overrides = {}) {
  const TemporaryFolder folder;
  return cases::read_case(folder.write("case.toml", text), overrides);
}

inline void check_case_refused(const std::string& text, const Mistake& mistake) {
  check_refused(text, mistake, [](const std::string& path) { cases::read_case(path); });
}

/// Requires that each mistake in good_case is refused.
inline void check_mistakes(const std::vector<Mistake>& mistakes) {
  for (const Mistake& mistake : mistakes)
    check_case_refused(replaced(good_case, mistake.from, mistake.to), mistake);
}

} // namespace case_text
