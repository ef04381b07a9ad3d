#include "tests/support/case_text.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace springproof;

using namespace cases;
using namespace case_text;

// A check of the value at full load that forgets the history's factor, or what a step does with it. Looked
// for also in: load steps of statics (in_small_turns(), by 30 degrees), the static start of a motion
// (scene_before_start() has the factor), small_strain's 180 degrees, the zone of scaled_displacement, and
// studies that take other steps (sweep; --converge-time's are shorter): follow_motion() checks them.
namespace {

/// A bar that is turned by 300 degrees in 0.1 s. Line numbers matter.
const std::string turned_bar = R"(schema = 1
name = 'turned bar'
[body]
shape = 'box'
size = [40, 10, 10]
cells = [4, 1, 1]
[material]
model = 'linear_elastic'
youngs_modulus = 0.1
poissons_ratio = 0.3
density = 1000
[[fixed]]
region = 'x-'
[[moved]]
region = 'x+'
angle = 300
axis = 'x'
centre = [40, 5, 5]
history = { ramp = [0, 0.1] }
[dynamics]
scheme = 'implicit_euler'
step = 0.05
end = 0.1
[[measure]]
name = 'twist'
kind = 'twist'
node = 'x+ y+ z+'
centre = 'x+ y- z-'
axis = 'x'
)";

void check_refused(const std::string& from, const std::string& to,
                   const std::vector<std::string>& fragments) {
  check_case_refused(replaced(turned_bar, from, to), 15, "moved[0].region", fragments);
}

} // namespace

TEST_CASE("a region turns by 30 degrees at most in a step in time, or the step that would do is told") {
  check_refused("step = 0.05", "step = 0.05", {"by 150 degrees", "at most 30", "steps of 0.01 s or shorter"});
  check_refused("step = 0.05", "step = 0.02", {"by 60 degrees", "steps of 0.01 s or shorter"});
  CHECK(read_text(replaced(turned_bar, "step = 0.05", "step = 0.01")).moved[0].angle == 300);
  // Turns of 30 degrees at full load, and of 300 with the history's factor.
  const std::string ten_times = replaced(turned_bar, "{ ramp = [0, 0.1] }", "[[0, 0], [0.1, 10]]");
  check_case_refused(replaced(ten_times, "angle = 300", "angle = -30"), 15, "moved[0].region",
                     {"by 150 degrees", "steps of 0.01 s or shorter"});
  // There and back within a step, which the ends of the step do not show.
  check_refused("{ ramp = [0, 0.1] }", "[[0, 0], [0.025, 1], [0.05, 0]]", {"by 300 degrees"});
  check_refused("{ ramp = [0, 0.1] }", "{ sine = 20 }", {"by 600 degrees", "at most 30"});
  // Nothing turns beyond the end.
  CHECK(read_text(replaced(turned_bar, "{ ramp = [0, 0.1] }", "[[0, 0], [0.1, 0.1], [0.11, 50]]"))
            .moved.size() == 1);
  check_refused("{ ramp = [0, 0.1] }", "[[0, 0], [1e-9, 1]]", {"a slower history"});
}

TEST_CASE("the step that is told is short enough, and one that has a step less is not") {
  const auto history = GENERATE(as<std::string>(), "{ ramp = [0.013, 0.1] }", "{ sine = 7 }",
                                "[[0, 0], [0.02, 0.7], [0.03, -0.4], [0.1, 1.3]]");
  const Case wanted =
      read_text(replaced(replaced(turned_bar, "{ ramp = [0, 0.1] }", history), "angle = 300", "angle = 3"));
  Case turned = wanted;
  turned.moved[0].angle = 300;
  const auto is_refused = [&](double step) {
    turned.dynamics->step = step;
    try {
      check_turns_in_time(turned);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const std::string message = is_refused(0.05), before = "take steps of ";
  REQUIRE(message.find(before) != std::string::npos);
  const double told = std::stod(message.substr(message.find(before) + before.size()));
  const double n_steps = std::round(0.1 / told);
  CHECK(is_refused(0.1 / n_steps).empty());
  CHECK_FALSE(is_refused(0.1 / (n_steps - 1)).empty());
}

TEST_CASE("factors of a history between two times are those of its corners and crests too") {
  const auto between = [](const History& history, double begin, double end) {
    const auto [least, most] = history.factors_between(begin, end);
    for (int i = 0; i <= 1000; ++i) { // no sample is outside
      const double factor = history.at(begin + (end - begin) * i / 1000);
      CHECK((least <= factor && factor <= most));
    }
    return std::pair(least, most);
  };
  const History zigzag{{{0, 0}, {1, 2}, {2, -3}, {4, 1}}};
  CHECK(between(zigzag, 0.5, 1.5) == std::pair(-0.5, 2.));
  CHECK(between(zigzag, 3, 9) == std::pair(-1., 1.));
  CHECK(between({}, 0, 1) == std::pair(1., 1.));
  const History sine{{}, 1};
  CHECK(between(sine, 0.2, 0.3).second == 1);
  CHECK(between(sine, 0.3, 0.8).first == -1);
  CHECK(between(sine, 0.3, 0.8).second == Approx(std::sin(0.6 * std::acos(-1.0))));
  CHECK(between(sine, 0, 50) == std::pair(-1., 1.));
}

TEST_CASE("small strains and the zone that is scaled are held against a history's largest factor") {
  const std::string slow = replaced(turned_bar, "step = 0.05", "step = 0.001"),
                    small = slow + "[fem]\nformulation = 'small_strain'\n",
                    twice = replaced(replaced(small, "{ ramp = [0, 0.1] }", "[[0, 0], [0.1, -2]]"),
                                     "angle = 300", "angle = 100");
  check_case_refused(twice, 15, "moved[0].region", {"200 degrees", "at most 180"});
  CHECK(read_text(replaced(twice, "-2", "-1.7")).moved.size() == 1);
  const std::string scaled = replaced(replaced(slow, "angle = 300\naxis = 'x'\ncentre = [40, 5, 5]",
                                               "displacement = [-3, 0, 0]\nscaled_displacement = { point = "
                                               "[30, 0, 0], normal = 'x', length = 10 }"),
                                      "{ ramp = [0, 0.1] }", "[[0, 0], [0.1, 4]]");
  check_case_refused(scaled, 17, "moved[0].scaled_displacement", {"12 mm", "history"});
  CHECK(read_text(replaced(scaled, "0.1, 4", "0.1, 3")).moved.size() == 1);
  check_case_refused(replaced(replaced(scaled, "[-3,", "[3,"), "0.1, 4", "0.1, -4"), 17,
                     "moved[0].scaled_displacement", {"12 mm"});
}
