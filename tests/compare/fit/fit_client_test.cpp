#include "cases/case/error.hpp"
#include "compare/fit/fit.hpp"
#include "tests/support/temporary_folder.hpp"

#include <catch2/catch.hpp>
#include <fmt/format.h>

using namespace springproof;
using namespace compare;

namespace {

/// A bar under tension, with the case's springs for a client that has no use for them.
const std::string engine_bar = R"(schema = 1
name = "bar"
body = { shape = "box", size = [10, 10, 10], cells = [1, 1, 1] }
material = { model = "linear_elastic", youngs_modulus = 1, poissons_ratio = 0.3, density = 1000 }
symmetry = [{ plane = "x-" }, { plane = "y-" }, { plane = "z-" }]
load = [{ region = "z+", kind = "traction", value = [0, 0, 0.01] }]
msm = { design = "hybrid" }
measure = [{ name = "length", kind = "displacement", node = "near 0 0 10", component = "z" },
           { name = "width", kind = "displacement", node = "near 10 0 0", component = "x" }]
)";

/// An engine whose own parameters are a modulus and a contraction: u = (-c x, -c y, z) F/(100 mm² E) in all
/// places. It stops early, so that four digits are right.
constexpr const char* engine = R"(
import json, struct, sys
modulus, contraction = map(float, sys.argv[1:3])
header = json.loads(sys.stdin.buffer.readline())
for entry in header["arrays"]:
    raw = sys.stdin.buffer.read(8 * entry["shape"][0] * entry["shape"][1])
    values = struct.unpack("<%dd" % (len(raw) // 8), raw)
    if entry["name"] == "nodes": nodes = values
    if entry["name"] == header["loads"][0]["forces"]: force = sum(values[3::4])
strain = force / 1e-4 / (modulus * 1e6)
u = [float("%.4g" % (x * strain * (1 if i % 3 == 2 else -contraction))) for i, x in enumerate(nodes)]
out = sys.stdout.buffer
def say(line): out.write(json.dumps(line).encode() + b"\n")
say({"protocol": 1, "name": "x", "version": "1", "method": "none", "settings": {}, "unsupported": []})
say({"frame": 0, "time": 1, "seconds": 0, "steps": 1, "at_rest": True, "has": "displacements", "nodes": len(u) // 3})
out.write(struct.pack("<%dd" % len(u), *u))
say({"end": True})
)";

constexpr double engine_modulus = 0.62, engine_contraction = 0.41;

/// Length and width under tractions, as the engine has them with its true parameters, to 0.5 %.
std::string lengths_and_widths() {
  std::string text = "load[0].value[2],length,width\n";
  for (int i = 1; i <= 6; ++i) {
    const double traction = 0.002 * i, strain = traction / engine_modulus,
                 error = i % 2 == 0 ? 0.005 : -0.005;
    text += fmt::format("{},{:.17g},{:.17g}\n", traction, 10 * strain * (1 + error),
                        -10 * engine_contraction * strain * (1 - error));
  }
  return text;
}

Fit fit_engine(const std::vector<std::string>& free, const std::string& arguments) {
  const TemporaryFolder folder;
  const FitCases cases{{folder.write("bar.toml", engine_bar)}, {}, {}};
  const std::optional<Client> client{
      {"engine",
       {"/usr/bin/python3", "-c", engine, arguments.substr(0, arguments.find(' ')),
        arguments.substr(arguments.find(' ') + 1)}}};
  const AnswerQuestions no_springs = [](const std::vector<Question>&) -> std::vector<Answers> {
    FAIL("our springs were asked");
    return {};
  };
  return fit_cases(cases, read_fit_data(lengths_and_widths(), "data.csv", cases), "data.csv", free,
                   cases::Side::msm, no_springs, client);
}

bool are_clients_refused(const Fit& fit) {
  const bool are = fit.found.failure.find("cannot confine a program") != std::string::npos;
  if (are) WARN("nothing was checked: " + fit.found.failure);
  return are;
}

} // namespace

TEST_CASE("parameters of another engine are found through its command, without derivatives", "[long]") {
  const Fit fit = fit_engine({"client.modulus=1", "client.contraction=0.3"}, "{modulus} {contraction}");
  if (are_clients_refused(fit)) return;
  INFO(fit.found.failure);
  REQUIRE(fit.found.has_values());
  CHECK(fit.model == "engine");
  CHECK(fit.found.parameters[0] == Approx(engine_modulus).epsilon(0.005)); // the data's errors
  CHECK(fit.found.parameters[1] == Approx(engine_contraction).epsilon(0.01));
  for (Eigen::Index p = 0; p < 2; ++p) {
    const double truth = p == 0 ? engine_modulus : engine_contraction;
    CHECK(fit.found.lower[p] < truth);
    CHECK(fit.found.upper[p] > truth);
    CHECK(fit.found.upper[p] - fit.found.lower[p] < 0.03 * truth); // 95 % of twelve data with 0.5 %
  }
  CHECK(fit.found.noise.value() > 1e-5); // four digits: 3e-5 of 9.999, 3e-4 of 1.000
  CHECK(fit.found.noise.value() < 3e-4);
  CHECK(fit.found.step == Approx(std::cbrt(*fit.found.noise)));
  CHECK(fit.held_out.error_percent.value() < 1);
  CHECK(fit.settings.empty()); // no key of a case
}

TEST_CASE("what a client does not answer to is undetermined", "[long]") {
  const Fit fit = fit_engine({"client.modulus=1", "material.youngs_modulus"}, "{modulus} 0.41");
  if (are_clients_refused(fit)) return;
  INFO(fit.found.failure);
  REQUIRE(fit.found.undetermined.size() == 1);
  CHECK(fit.found.undetermined[0] == "+1.00 material.youngs_modulus");
}

TEST_CASE("a client's parameter that its command has no place for is refused") {
  CHECK_THROWS_WITH(
      fit_engine({"client.modulus=1"}, "{modulos} 0.3"),
      "--free: client.modulus: the command of --client must have {modulus} where its value belongs");
}
