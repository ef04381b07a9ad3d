
#include "cases/case/error.hpp"
#include "cases/case/installation.hpp"
#include "compare/provenance/whole_file.hpp"
#include "compare/solve/fields.hpp"
#include "compare/solve/kept.hpp"
#include "tests/support/temporary_folder.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <sstream>

using namespace springproof;

using compare::Answers;
using compare::FinishedCases;
using compare::Question;

namespace {

cases::Case cell(const std::string& name) {
  cases::Case definition;
  definition.name = name;
  definition.file = name + ".toml";
  definition.body = cases::Box{{1, 1, 1}, {1, 1, 1}};
  definition.material = cases::LinearElastic{1, 0.3};
  definition.fixed.push_back({{"z-", std::nullopt, {"a.toml", 7, 1, "fixed[0].region"}}});
  definition.loads.push_back({{"z+"}, cases::loads::Traction{{0, 0, 1}}});
  return definition;
}

Question question(const std::string& name = "cell") {
  return {cases::make_scene(cell(name)), {}};
}

Answers answers() {
  Answers answers;
  answers.choices = {"formulation: \"small\"\n"};
  answers.msm.solution.status = cases::Status::converged;
  answers.msm.solution.message = "with a\nline break";
  answers.msm.solution.displacement.assign(8, {1, 2, 3});
  answers.msm.solution.displacement[1] = {-0.0, 5e-324, 1e308};
  answers.msm.solution.cell_volume = {1.5};
  answers.msm.solution.fields = cases::Fields{std::vector<Eigen::Vector3d>(8, {0.1, -0.0, 5e-324}),
                                              0.3,
                                              true,
                                              {0.3},
                                              {{1, 2, 3, 4, 5, 6}},
                                              {{-1, 0.1, 0, 0, 0, 1e-300}}};
  answers.msm.solution.negative_eigenvalues = 2;
  answers.msm.solve_seconds = 0.1;
  answers.design = msm::DesignResult{};
  answers.design->warnings = {"one", ""};
  answers.refined = compare::RefinedMeshes{{0, 1}, {answers.msm.solution, {}}, ""};
  answers.peer = compare::Peer{"CalculiX", {}, 1e-7};
  return answers;
}

/// A folder in which an answer is kept, and its file.
struct Kept {
  TemporaryFolder folder;
  std::string file = (folder.path / "solved/cell").string();
  FinishedCases finished{folder.path.string(), {question()}};
  Kept() { finished.keep(question(), answers()); }
  Kept(const Kept&) = delete;
};

/// Whether anything is found when the file holds these bytes, and what is said about it.
struct Found {
  bool is_something;
  std::string message;
};
Found find_in(const Kept& kept, const std::string& bytes) {
  std::ofstream(kept.file, std::ios::binary) << bytes;
  std::ostringstream messages;
  std::streambuf* const standard_error = std::cerr.rdbuf(messages.rdbuf());
  const bool is_something = kept.finished.find(question()).has_value();
  std::cerr.rdbuf(standard_error);
  return {is_something, messages.str()};
}

} // namespace

TEST_CASE("kept answers come back as they were, to the last bit") {
  const Kept kept;
  const Answers before = answers(), after = kept.finished.find(question()).value();
  CHECK(after.choices == before.choices);
  CHECK(after.fem.solution.status == cases::Status::skipped);
  CHECK(after.msm.solution.message == before.msm.solution.message);
  CHECK(after.msm.solution.displacement == before.msm.solution.displacement);
  CHECK(after.msm.solution.fields->reaction == before.msm.solution.fields->reaction);
  CHECK(after.msm.solution.fields->total_energy == before.msm.solution.fields->total_energy);
  CHECK(after.msm.solution.fields->strain_energy == before.msm.solution.fields->strain_energy);
  CHECK(after.msm.solution.fields->stress == before.msm.solution.fields->stress);
  CHECK(after.msm.solution.fields->strain == before.msm.solution.fields->strain);
  CHECK_FALSE(after.fem.solution.fields);
  CHECK(std::signbit(after.msm.solution.displacement[1].x()));
  CHECK(after.msm.solution.negative_eigenvalues == 2);
  CHECK_FALSE(after.msm.solution.lowest_eigenvalue);
  CHECK(after.msm.solve_seconds == 0.1);
  CHECK(after.design->warnings == before.design->warnings);
  CHECK(after.refined->refine == before.refined->refine);
  CHECK(after.refined->solutions[0].displacement == before.msm.solution.displacement);
  CHECK(after.peer->largest_difference == 1e-7);
}

TEST_CASE("a kept file that is cut at any byte counts as none, with one line that names it") {
  const Kept kept;
  const std::string whole = compare::read_file(kept.file);
  CHECK(find_in(kept, whole).is_something);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const Found found = find_in(kept, whole.substr(0, size));
    CAPTURE(size, found.message);
    REQUIRE_FALSE(found.is_something);
    REQUIRE(found.message.rfind(kept.file + ": ", 0) == 0);
    REQUIRE(std::count(found.message.begin(), found.message.end(), '\n') == 1);
  }
  CHECK_FALSE(find_in(kept, whole + "x").is_something);
}

TEST_CASE("a kept file with any one bit flipped counts as none") {
  const Kept kept;
  const std::string whole = compare::read_file(kept.file);
  for (std::size_t at = 0; at < whole.size(); ++at)
    for (int bit = 0; bit < 8; ++bit) {
      std::string damaged = whole;
      damaged[at] = static_cast<char>(damaged[at] ^ (1 << bit));
      CAPTURE(at, bit);
      REQUIRE_FALSE(find_in(kept, damaged).is_something);
    }
}

TEST_CASE("a kept file of another format counts as none, and its line says so") {
  const Kept kept;
  std::string other = compare::read_file(kept.file);
  const std::size_t number = other.find(", format ") + 9;
  REQUIRE(number < other.find('\n'));
  other[number] = '0'; // none has it
  CHECK_THAT(find_in(kept, other).message, Catch::Contains("another format"));
  CHECK_THAT(find_in(kept, "as a program before it kept them").message, Catch::Contains("another format"));
}

TEST_CASE("a kept file with a sound digest of answers that are none counts as none") {
  const Kept kept;
  const std::string whole = compare::read_file(kept.file);
  const std::size_t line = whole.find('\n') + 1, result = whole.find('\n', line) + 1;
  const std::string identity = whole.substr(line, whole.find(' ', line) - line);
  const auto find_forged = [&](const std::string& content) {
    return find_in(kept, compare::kept_text(identity, content));
  };
  CHECK(find_forged(whole.substr(result)).is_something);
  CHECK_FALSE(find_forged(whole.substr(result, (whole.size() - result) / 2)).is_something);
  Answers forged = answers();
  forged.msm.solution.displacement.resize(7);
  CHECK_FALSE(find_forged(cases::to_bytes(forged)).is_something);
  forged = answers();
  forged.msm.solution.cell_volume.clear();
  CHECK_FALSE(find_forged(cases::to_bytes(forged)).is_something);
  forged = answers();
  forged.msm.solution.fields->stress.clear();
  CHECK_FALSE(find_forged(cases::to_bytes(forged)).is_something);
  forged = answers();
  forged.msm.solution.fields->has_stress = false;
  CHECK_FALSE(find_forged(cases::to_bytes(forged)).is_something);
  forged = answers();
  forged.msm.solution.fields->strain[0][2] = std::nan("");
  CHECK_FALSE(find_forged(cases::to_bytes(forged)).is_something);
  forged = answers();
  forged.refined->refine = {0, 1, 2};
  CHECK_FALSE(find_forged(cases::to_bytes(forged)).is_something);
  forged = answers();
  forged.peer->answer.solution.displacement.resize(8, Eigen::Vector3d::Constant(std::nan("")));
  const Found found = find_forged(cases::to_bytes(forged));
  CHECK_FALSE(found.is_something);
  CHECK(found.message.rfind(kept.file + ": ", 0) == 0);
}

TEST_CASE("answers are for one case, one request and one setting of PETSc") {
  const Kept kept;
  const auto is_found = [&](const Question& other) { return kept.finished.find(other).has_value(); };
  Question other = question();
  other.request.only = cases::Side::msm;
  CHECK_FALSE(is_found(other));
  other = question();
  other.request.meshes = 3;
  CHECK_FALSE(is_found(other));
  other = question();
  other.scene.definition.msm.split = 0.5;
  CHECK_FALSE(is_found(other));
  other = question();
  other.scene.mesh.nodes.stored()[7].x() += 1e-15; // from a file that gmsh read
  CHECK_FALSE(is_found(other));
  setenv("PETSC_OPTIONS", "-ksp_rtol 1", 1);
  CHECK_FALSE(is_found(question()));
  unsetenv("PETSC_OPTIONS");
  CHECK(is_found(question()));
}

TEST_CASE("a program is known by the shared objects that hold its models") {
  const std::string library = cases::own_file(), solvers = cases::private_file("springproof_solvers.so");
  CHECK_THAT(library, Catch::Contains("libspringproof.so")); // not the program that is started
  const std::string digest = compare::digest_of_files({library, solvers});
  CHECK_THAT(compare::this_program(), Catch::EndsWith(" " + digest));
  const TemporaryFolder folder;
  std::string bytes = compare::read_file(library);
  const std::string copy = folder.write("library", bytes);
  CHECK(compare::digest_of_files({copy, solvers}) == digest);
  bytes[bytes.size() / 2] ^= 1;
  folder.write("library", bytes);
  CHECK(compare::digest_of_files({copy, solvers}) != digest);
  const std::string other = folder.write("solvers", "other solvers");
  CHECK(compare::digest_of_files({library, other}) != digest);
  CHECK(compare::digest_of_files({library, other}) !=
        compare::digest_of_files({library, (folder.path / "none").string()}));
}

TEST_CASE("a case is the same wherever its file lies and its lines stand") {
  const Kept kept;
  Question moved = question();
  moved.scene.definition.file = "elsewhere/cell.toml";
  moved.scene.definition.fixed[0].region.where.line = 8;
  CHECK(kept.finished.find(moved));
}

TEST_CASE("failed solves are not kept, and without a folder nothing is") {
  const TemporaryFolder folder;
  const FinishedCases finished(folder.path.string(), {});
  Answers failed = answers();
  failed.fem.solution.status = cases::Status::failed;
  finished.keep(question(), failed);
  CHECK_FALSE(finished.find(question()));
  const FinishedCases nowhere("", {question("a"), question("a")});
  nowhere.keep(question(), answers());
  CHECK_FALSE(nowhere.find(question()));
}

TEST_CASE("two cases of one name cannot share a folder of results") {
  const TemporaryFolder folder;
  CHECK_THROWS_WITH(FinishedCases(folder.path.string(), {question("a"), question("b"), question("a")}),
                    Catch::Contains("a.toml") && Catch::Contains("\"a\""));
}

TEST_CASE("a folder that cannot hold results is refused before anything is solved") {
  const TemporaryFolder folder;
  folder.write("solved", "in the way");
  CHECK_THROWS_AS(FinishedCases(folder.path.string(), {}), cases::InputError);
}
