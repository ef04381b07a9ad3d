#include "cases/case/read_case.hpp"
#include "tests/support/case_text.hpp"

using namespace springproof;

using namespace cases;
using namespace case_text;

namespace {

// Line numbers matter below: `[stress]` is on line 18.
const std::string good_stress = R"(schema = 1
name = "cube"
[body]
shape = "box"
size = [2, 2, 2]
cells = [2, 2, 2]
[material]
model = "linear_elastic"
youngs_modulus = 0.3
poissons_ratio = 0.35
[[fixed]]
region = "z-"
[[load]]
region = "z+"
kind = "nodal_force"
value = [0.002, 0, 0.0]

[stress]
start = "perturbed"
amplitude = 0.3
seed = 7
least_load_steps = 5
max_seconds = 10
max_iterations = 100
[stress.stiffer]
axis = "z"
beyond = 1
factor = 1e6
[stress.msm]
outcome = "limit point"
load_reached = [0.7, 0.8]
inverted_cells = 0
[stress.fem]
outcome = "stable equilibrium"
)";

constexpr auto read_hard = [](const std::string& path) { read_hard_case(path); };

Case read_hard_text(const std::string& text) {
  const TemporaryFolder folder;
  return read_hard_case(folder.write("case.toml", text));
}

} // namespace

TEST_CASE("a complete hard case is read to the last key") {
  const Case definition = read_hard_text(good_stress);
  CHECK(definition.name == "cube");
  const Stress& hard = definition.stress.value();
  CHECK_FALSE(hard.is_heavy);
  CHECK(hard.start == Start::perturbed);
  CHECK(hard.amplitude == 0.3);
  CHECK(hard.seed == 7);
  CHECK(hard.least_load_steps == 5);
  CHECK(hard.max_seconds == 10);
  CHECK(hard.max_iterations == 100);
  CHECK(definition.msm.design != Design::given);
  REQUIRE(hard.stiffer.has_value());
  CHECK(hard.stiffer->axis == Axis::z);
  CHECK(hard.stiffer->beyond == 1);
  CHECK(hard.stiffer->factor == 1e6);
  REQUIRE(hard.expected.size() == 2);
  CHECK(hard.expected[0].model == "msm");
  CHECK(hard.expected[0].side == Side::msm);
  CHECK(hard.expected[0].outcome == Outcome::limit_point);
  CHECK(hard.expected[0].load_reached == std::array<double, 2>{0.7, 0.8});
  CHECK(hard.expected[0].inverted_cells == 0);
  CHECK(hard.expected[1].side == Side::fem);
  CHECK(hard.expected[1].outcome == Outcome::stable_equilibrium);
  CHECK_FALSE(hard.expected[1].load_reached.has_value());
}

TEST_CASE("springs of any sign may be given to a hard case") {
  const Case hard =
      read_hard_text(replaced(good_stress, "max_seconds", "stiffness = [31, -20, 33]\nmax_seconds"));
  CHECK(hard.msm.design == Design::given);
  CHECK(hard.msm.stiffness == std::array<double, 3>{31, -20, 33});
}

TEST_CASE("every mistake in [stress] is refused where it is made") {
  const std::string start = "start = \"perturbed\"\namplitude = 0.3\nseed = 7\n";
  const auto refused = mistakes_in(good_stress, read_hard);
  refused(start, "start = \"invertd\"\n", 19, "stress.start", {"\"rest\"", "did you mean \"inverted\"?"});
  refused(start, "amplitude = 0.3\n", 19, "stress.amplitude", {"left out", "perturbed"});
  refused(start, "start = \"inverted\"\nseed = 3\n", 20, "stress.seed", {"left out", "perturbed"});
  refused("amplitude = 0.3", "amplitude = 0", 20, "stress.amplitude", {"above 0"});
  refused("seed = 7", "seed = 0.5", 21, "stress.seed", {"a whole number"});
  refused("seed = 7\n", "", 18, "stress.seed", {"is missing"});
  refused("least_load_steps = 5", "least_load_steps = 0", 22, "stress.least_load_steps", {"from 1 to 1000"});
  refused("least_load_steps", "least_load_step", 22, "stress.least_load_step",
          {"did you mean \"least_load_steps\"?"});
  refused("max_seconds = 10\n", "", 18, "stress.max_seconds", {"is missing", "above 0"});
  refused("max_iterations = 100", "max_iterations = inf", 24, "stress.max_iterations", {"a whole number"});
  refused("seed = 7", "seed = 7\nheavy = \"yes\"", 22, "stress.heavy", {"true or false"});
  refused("seed = 7", "seed = 7\nstiffness = [1, 2]", 22, "stress.stiffness", {"three finite numbers"});
  refused("factor = 1e6", "factor = -1", 28, "stress.stiffer.factor", {"above 0"});
  refused("axis = \"z\"", "axis = \"w\"", 26, "stress.stiffer.axis", {"\"x\" | \"y\" | \"z\""});
  refused("beyond = 1", "beyond = 1\nbelow = 2", 28, "stress.stiffer.below", {"is not a key here", "beyond"});
  refused("outcome = \"limit point\"", "outcome = \"limit_point\"", 30, "stress.msm.outcome",
          {"\"mechanism\"", "did you mean \"limit point\"?"});
  refused("outcome = \"limit point\"", "outcome = \"unknown\"", 30, "stress.msm.outcome", {"must be"});
  refused("outcome = \"limit point\"\n", "", 29, "stress.msm.outcome", {"is missing"});
  refused("[0.7, 0.8]", "[0.8, 0.7]", 31, "stress.msm.load_reached", {"lower <= upper"});
  refused("[0.7, 0.8]", "[0.7, 1.8]", 31, "stress.msm.load_reached", {"<= 1"});
  refused("inverted_cells = 0", "inverted_cells = -1", 32, "stress.msm.inverted_cells", {"from 0"});
  refused("[stress.fem]", "[stress.fme]", 33, "stress.fme", {"did you mean \"fem\"?"});
}

TEST_CASE("a hard case that expects nothing, or a hybrid of given springs, is refused") {
  const std::string without = good_stress.substr(0, good_stress.find("[stress.msm]"));
  check_refused(without, 18, "stress.msm", {"is missing", "[stress.hybrid]"}, read_hard);
  check_refused(replaced(good_stress, "seed = 7", "seed = 7\nstiffness = [1, 2, 3]") +
                    "[stress.hybrid]\noutcome = \"mechanism\"\n",
                22, "stress.stiffness", {"left out beside [stress.hybrid]"}, read_hard);
}

TEST_CASE("a hard case is no ordinary case, nor an ordinary case a hard one") {
  check_case_refused(good_stress, 18, "stress", {"hard case", "command stress"});
  check_refused(good_stress.substr(0, good_stress.find("[stress]")), 1, "stress", {"is missing", "[stress]"},
                read_hard);
}
