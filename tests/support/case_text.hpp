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

/// Requires that a reader refuses a text at a line and a key, with a message that says what is asked for.
template<class Reader>
void check_refused(const std::string& text, int line, const std::string& key,
                   const std::vector<std::string>& says, const Reader& read) {
  const TemporaryFolder folder;
  const std::string path = folder.write("case.toml", text);
  try {
    read(path);
    FAIL("accepted");
  } catch (const InputError& error) {
    const std::string message = error.what();
    INFO(message);
    CHECK(error.where().file == path);
    CHECK(error.where().key == key);
    CHECK(error.where().line == line);
    const std::string begin =
        path + ":" + std::to_string(line) + ":" + std::to_string(error.where().column) + ": ";
    CHECK(message.rfind(begin + (key.empty() ? "" : key + ": "), 0) == 0);
    CHECK(error.where().column >= 1);
    for (const std::string& part : says) CHECK_THAT(message, Catch::Contains(part));
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

/// Its body, without a line's end.
inline const std::string box_keys = "shape = 'box'\nsize = [10.0, 10.0, 10]\ncells = [10, 10, 10]";

inline cases::Case read_text(const std::string& text, const std::vector<std::string>& overrides = {}) {
  const TemporaryFolder folder;
  return cases::read_case(folder.write("case.toml", text), overrides);
}

inline constexpr auto read_any = [](const std::string& path) { cases::read_case(path); };

inline void check_case_refused(const std::string& text, int line, const std::string& key,
                               const std::vector<std::string>& says) {
  check_refused(text, line, key, says, read_any);
}

/// A function refused(from, to, line, key, says) that requires that a mistake in a good case is refused.
template<class Reader = decltype(read_any)>
auto mistakes_in(const std::string& good, const Reader& read = read_any) {
  return [good, read](const std::string& from, const std::string& to, int line, const std::string& key,
                      const std::vector<std::string>& says) {
    INFO("replaced: " << from << "\nby: " << to);
    check_refused(replaced(good, from, to), line, key, says, read);
  };
}

/// A beam that is let go under gravity, with a weight on its end. Line numbers matter.
inline const std::string dynamic_case = R"(schema = 1
name = 'beam'
[body]
shape = 'box'
size = [100, 30, 30]
cells = [20, 6, 6]
[material]
model = 'linear_elastic'
youngs_modulus = 0.26
poissons_ratio = 0.49
density = 1070
mass_damping = 0.5
stiffness_damping = 0.001
[dynamics]
scheme = 'newmark'
step = 0.01
end = 2
start = 'equilibrium'
[[fixed]]
region = 'x-'
[[load]]
kind = 'gravity'
value = [0, 0, -9.81]
[[load]]
region = 'x+'
kind = 'total_force'
value = [0, 1, 0]
history = [[0, 1], [0, 0]]
[[mass]]
region = 'x+ z+'
value = 0.052
[fem]
mass = 'lumped'
[msm]
mass = 'uniform'
[[measure]]
name = 'drop'
kind = 'displacement'
node = 'x+ y- z+'
component = 'z'
over_time = 'frequency'
)";

} // namespace case_text
