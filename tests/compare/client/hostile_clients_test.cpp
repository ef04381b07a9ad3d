#include "compare/client/ask_client.hpp"

#include "cases/case/error.hpp"
#include "cases/case/read_case.hpp"
#include "compare/solve/springs.hpp"
#include "tests/support/scene_in_tetrahedra.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <random>

using namespace springproof;
using compare::ClientAnswer;

namespace {

const std::string python = "/usr/bin/python3";

/// A cube of 2 x 2 x 2 cells under shear.
cases::Scene small_scene() {
  return cases::make_scene(cases::read_case(
      SPRINGPROOF_SOURCE_DIR "/cases/thesis/linear_elastic/cube_shear_small.toml", {"body.cells=[2,2,2]"}));
}

/// What all clients of these tests begin with: n is the number of nodes, hello() and frame() speak.
const std::string beginning = R"(
import json, os, socket, struct, subprocess, sys, time
out = sys.stdout.buffer
def say(line, raw=b""): out.write((json.dumps(line) if isinstance(line, dict) else line).encode() + b"\n" + raw); out.flush()
def read():
    header = json.loads(sys.stdin.buffer.readline())
    for entry in header["arrays"]:
        raw = sys.stdin.buffer.read(8 * entry["shape"][0] * entry["shape"][1])
        if entry["name"] == "nodes": nodes = struct.unpack("<%dd" % (len(raw) // 8), raw)
    return nodes
def hello(**more): say({"protocol": 1, "name": "x", "version": "1", "method": "none", "settings": {}, "unsupported": [], **more})
def frame(values, raw=None, **more):
    say({"frame": 0, "time": 1, "seconds": 0, "steps": 1, "at_rest": True, "has": "positions", "nodes": len(values) // 3, **more},
        struct.pack("<%dd" % len(values), *values) if raw is None else raw)
)";

ClientAnswer answer_of(const std::string& program, double seconds = 3) {
  compare::ClientBudget budget;
  budget.start_seconds = budget.seconds = seconds;
  return compare::ask_client(small_scene(), {"x", {python, "-c", beginning + program}}, budget);
}

/// Why the client's row failed; empty if it did not.
std::string failure_of(const std::string& program, double seconds = 3) {
  const ClientAnswer found = answer_of(program, seconds);
  return found.answer.converged() ? "" : found.answer.solution.message;
}

/// Says why nothing can be tested where the system refuses namespaces, as containers often do.
bool are_clients_refused() {
  static const std::string reason = failure_of("");
  const bool are = reason.find("cannot confine a program") != std::string::npos;
  if (are) WARN("nothing was checked: " + reason);
  return are;
}

/// Processes of this system whose command line has a word.
int n_processes_with(const std::string& word) {
  int n = 0;
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    std::ifstream in(entry.path() / "cmdline", std::ios::binary);
    const std::string line((std::istreambuf_iterator<char>(in)), {});
    n += line.find(word) != std::string::npos ? 1 : 0;
  }
  return n;
}

} // namespace

TEST_CASE("a client that hangs, crashes or speaks nonsense is a failed row that says why", "[long]") {
  if (are_clients_refused()) return;
  const auto [what, program, reason] = GENERATE(table<const char*, const char*, const char*>({
      {"hangs before reading", "time.sleep(60)", "introducing itself: took longer than 3 s"},
      {"hangs after reading", "read(); time.sleep(60)", "introducing itself: took longer than 3 s"},
      {"hangs after its introduction", "read(); hello(); time.sleep(60)", "frame 0: took longer than"},
      {"hangs within a frame", "x = read(); hello(); frame(x, raw=b'12345678'); time.sleep(60)",
       "frame 0: took longer than"},
      {"hangs instead of ending", "x = read(); hello(); frame(x); time.sleep(60)",
       "after 1 frame: took longer than"},
      {"does not start", "import no_such_module", "ended early, with status 1; it said:"},
      {"crashes", "read(); hello(); os.abort()", "crashed (Aborted)"},
      {"ends early", "x = read(); hello()", "frame 0: ended early, with status 0"},
      {"NaN", "x = read(); hello(); frame([float('nan')] * len(x))", "node 0 is at no finite place"},
      {"diverged", "x = read(); hello(); frame([1e9] * len(x))", "the answer has diverged"},
      {"infinite", "x = read(); hello(); frame([float('inf')] * len(x))", "node 0 is at no finite place"},
      {"too few nodes", "x = read(); hello(); frame(x[3:])", "26 nodes, the scene has 27"},
      {"too many nodes", "x = read(); hello(); frame(x + x[:3])", "28 nodes, the scene has 27"},
      {"another frame", "x = read(); hello(); frame(x, frame=1)", "\"frame\" is 1, must be 0"},
      {"one frame more", "x = read(); hello(); frame(x); frame(x)", "it goes on"},
      {"chatter before", "read(); say('Welcome to X 1.0'); hello()", "no JSON object: \"Welcome to X 1.0\""},
      {"chatter after", "x = read(); hello(); say('step 1')", "no JSON object: \"step 1\""},
      {"another protocol", "read(); hello(protocol=2)", "protocol is 2, must be 1"},
      {"ignores nothing it says", "read(); hello(unsupported=3)", "\"unsupported\" is missing or no list"},
      {"a line of gigabytes", "read()\nwhile True: out.write(b'a' * 1000000)", "a line of more than"},
      {"negative time", "x = read(); hello(); frame(x, seconds=-1)", "\"seconds\" is missing or no number"},
      {"gives up", "read(); hello(); say({'error': 'no convergence'})", "it gave up: no convergence"},
  }));
  INFO(what);
  CHECK_THAT(failure_of(program), Catch::Contains(reason));
}

TEST_CASE("a client cannot write outside its folder, use the network, or leave processes behind") {
  if (are_clients_refused()) return;
  const std::string place = (std::filesystem::temp_directory_path() / "springproof-outside").string();
  std::filesystem::remove(place);
  CHECK_THAT(failure_of("open('" + place + "', 'w')"), Catch::Contains("Read-only file system"));
  CHECK_FALSE(std::filesystem::exists(place));
  CHECK_THAT(failure_of("socket.socket()"), Catch::Contains("Operation not permitted"));
  CHECK_THAT(failure_of("socket.socket(socket.AF_UNIX)"), Catch::Contains("Operation not permitted"));
  // Its own folder is writable, and what it starts ends with it.
  const std::string mark = "springproof_left_behind";
  const std::string fork = "x = read(); open('a', 'w').write('b')\n"
                           "subprocess.Popen([sys.executable, '-c', 'import time; time.sleep(100)', '" +
                           mark + "'], start_new_session=True)\nhello(); frame(x); say({'end': True})";
  CHECK(failure_of(fork).empty());
  CHECK(n_processes_with(mark + std::string(1, '\0')) == 0);
}

TEST_CASE("a client's answer stands in place of the springs', with what the client ignores as a warning") {
  if (are_clients_refused()) return;
  const std::string still = "x = read(); hello(unsupported=['midlines']); frame(x); say({'end': True})";
  const compare::Answers answers =
      compare::with_client({}, small_scene(), {"mine", {python, "-c", beginning + still}});
  CHECK(answers.msm.converged());
  CHECK(answers.msm_source == "mine (x 1, none)");
  CHECK_THAT(answers.msm_warnings, Catch::VectorContains(std::string("mine ignores midlines")));
  const compare::Answers none =
      compare::with_client({}, small_scene(), {"mine", {python, "-c", "raise SystemExit(3)"}});
  CHECK(none.failed());
  CHECK(none.msm_source == "mine");
}

namespace {

/// A right answer to small_scene(): the introduction, a frame of displacements that are all 0, the end.
std::string right_answer(std::size_t n_nodes) {
  return R"({"protocol": 1, "name": "x", "version": "1", "method": "none", )"
         R"("settings": {"a": [1]}, "unsupported": []})"
         "\n"
         R"({"frame": 0, "time": 1.5, "seconds": 0.25, "steps": 10, "at_rest": true, )"
         R"("has": "displacements", "nodes": )" +
         std::to_string(n_nodes) + "}\n" + std::string(24 * n_nodes, '\0') + "{\"end\": true}\n";
}

/// Some bytes changed, left out, doubled or moved, or the rest cut off.
std::string mutated(std::string bytes, std::mt19937& random) {
  const auto below = [&](std::size_t n) {
    return std::uniform_int_distribution<std::size_t>(0, n - 1)(random);
  };
  for (std::size_t change = 0; change <= below(4); ++change) {
    const std::size_t at = below(bytes.size()),
                      length = 1 + below(std::min<std::size_t>(16, bytes.size() - at));
    switch (below(5)) {
    case 0:
      bytes[at] = static_cast<char>(below(256));
      break;
    case 1:
      bytes[at] = "0123456789-.eE\"{}[]:,\n"[below(22)];
      break;
    case 2:
      bytes.erase(at, length);
      break;
    case 3:
      bytes.insert(at, bytes.substr(below(bytes.size()), length));
      break;
    default:
      if (below(10) == 0) bytes.resize(at + 1);
    }
    if (bytes.empty()) bytes = "\n";
  }
  return bytes;
}

} // namespace

TEST_CASE("a thousand mutated answers are answers with finite displacements or failed rows with a reason",
          "[long]") {
  if (are_clients_refused()) return;
  const cases::Scene scene = small_scene();
  compare::ClientBudget budget;
  budget.start_seconds = budget.seconds = 20;
  const std::size_t scene_bytes = compare::scene_message(scene, budget).size();
  const std::filesystem::path file = std::filesystem::temp_directory_path() / "springproof-mutated-answer";
  const std::string speak = fmt::format("head -c {} > /dev/null; cat '{}'", scene_bytes, file.string());
  std::mt19937 random(41);
  int n_answers = 0;
  for (int i = 0; i < 1000; ++i) {
    const std::string right = right_answer(scene.mesh.nodes.size());
    std::ofstream(file, std::ios::binary) << (i == 0 ? right : mutated(right, random));
    const ClientAnswer found = compare::ask_client(scene, {"x", {"sh", "-c", speak}}, budget);
    INFO("answer " << i << ": " << found.answer.solution.message);
    if (i == 0) CHECK(found.answer.converged());
    if (!found.answer.converged()) {
      CHECK_FALSE(found.answer.solution.message.empty());
      CHECK(found.answer.solve_seconds < 10); // each ends by itself: no answer is waited for
      continue;
    }
    ++n_answers;
    REQUIRE(found.answer.solution.displacement.size() == scene.mesh.nodes.size());
    for (const Eigen::Vector3d& u : found.answer.solution.displacement) CHECK(u.allFinite());
  }
  std::filesystem::remove(file);
  CHECK(n_answers > 100); // changes of names, and of displacements to others
  CHECK(n_answers < 900);
}

TEST_CASE("displacements in other axes or units are warned of") {
  if (are_clients_refused()) return;
  const auto equilibrium = [](const std::string& changed) {
    std::optional<msm::DesignResult> design;
    const compare::Answer springs = compare::solve_springs(small_scene(), 1, design);
    std::string values;
    for (const Eigen::Vector3d& u : springs.solution.displacement)
      values += fmt::format("({:.17g}, {:.17g}, {:.17g}),", u.x() * 1e-3, u.y() * 1e-3, u.z() * 1e-3);
    return answer_of("x = read(); u = [" + values + "]\nhello(); frame([c for a in u for c in (" + changed +
                     ")], has='displacements'); say({'end': True})");
  };
  const ClientAnswer right = equilibrium("a");
  CHECK(right.answer.converged());
  CHECK(right.warnings.empty());
  CHECK_FALSE(equilibrium("(a[1], a[2], a[0])").warnings.empty());
  CHECK_FALSE(equilibrium("(1000 * a[0], 1000 * a[1], 1000 * a[2])").warnings.empty());
}

namespace {

/// Largest difference of the reference client's displacements from our own springs', of the largest
/// displacement: of those at rest, or of all those of a motion.
double difference_of_reference(const cases::Scene& scene) {
  std::optional<msm::DesignResult> design;
  const compare::Answer springs = compare::solve_springs(scene, 1, design);
  REQUIRE(springs.converged());
  const ClientAnswer client = compare::ask_client(
      scene, {"reference", {python, SPRINGPROOF_SOURCE_DIR "/clients/reference/client.py"}}, {});
  INFO(client.answer.solution.message);
  REQUIRE(client.answer.converged());
  CHECK(client.introduction->unsupported.empty());
  double largest = 0, difference = 0;
  const auto compare_bodies = [&](const std::vector<Eigen::Vector3d>& ours,
                                  const std::vector<Eigen::Vector3d>& theirs) {
    REQUIRE(ours.size() == theirs.size());
    for (std::size_t n = 0; n < ours.size(); ++n) {
      largest = std::max(largest, ours[n].norm());
      difference = std::max(difference, (ours[n] - theirs[n]).norm());
    }
  };
  compare_bodies(springs.solution.displacement, client.answer.solution.displacement);
  if (scene.definition.dynamics) {
    const auto& ours = springs.solution.trajectory->bodies;
    const auto& theirs = client.answer.solution.trajectory->bodies;
    REQUIRE(ours.size() == theirs.size());
    for (std::size_t b = 0; b < ours.size(); ++b) {
      CHECK(ours[b].step == theirs[b].step);
      compare_bodies(ours[b].displacement, theirs[b].displacement);
    }
  }
  return difference / largest;
}

} // namespace

// Newton's method stops at 1e-9 of the forces, or well below.
TEST_CASE("the reference client has our own springs' equilibrium to 1e-9", "[verification]") {
  if (are_clients_refused()) return;
  CHECK(difference_of_reference(small_scene()) < 1e-9);
}

TEST_CASE("so it has that of tetrahedra, whose volume terms are at nodes", "[verification]") {
  if (are_clients_refused()) return;
  const auto design = GENERATE(as<std::string>(), "hybrid", "matched", "biquadratic");
  INFO(design);
  const cases::Case definition =
      cases::read_case(SPRINGPROOF_SOURCE_DIR "/cases/thesis/linear_elastic/cube_shear_small.toml",
                       {"body.cells=[2,2,2]", "material.poissons_ratio=0.3", "msm.design=" + design});
  const cases::Scene scene = tetrahedra::make_scene(definition, cases::Element::p1);
  CHECK(scene.mesh.shape == cases::CellShape::tetrahedron);
  CHECK(difference_of_reference(scene) < 1e-9);
}

TEST_CASE("and that of a damped motion, under a load with a history", "[verification]") {
  if (are_clients_refused()) return;
  const auto design = GENERATE(as<std::string>(), "moduli", "hybrid", "midline");
  INFO(design);
  const cases::Scene scene = cases::make_scene(
      cases::read_case(SPRINGPROOF_SOURCE_DIR "/cases/thesis/linear_elastic/cube_shear_small.toml",
                       {"body.cells=[2,2,2]", "material.poissons_ratio=0.25", "material.density=1000",
                        "material.mass_damping=4", "material.stiffness_damping=1e-4", "msm.design=" + design,
                        "load[0].history=[[0,0],[0.004,1],[0.02,-0.5]]",
                        "dynamics={scheme=\"implicit_euler\",step=0.001,end=0.02,write_every=1}"}));
  CHECK(difference_of_reference(scene) < 1e-9);
}
