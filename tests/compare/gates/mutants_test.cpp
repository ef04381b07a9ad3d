// The gates gate: what can go wrong in a simulator or in its measuring is done to a case on purpose, and some
// gate must say so. The mutants live here alone; the program knows nothing of them.

#include "compare/write/write.hpp"

#include "cases/case/read_case.hpp"

#include <catch2/catch.hpp>
#include <functional>
#include <limits>
#include <stdexcept>

using namespace springproof;

using cases::Case;
using compare::Comparison;

namespace {

const std::string cases_path = SPRINGPROOF_SOURCE_DIR "/cases/";

Case read(const std::string& file) {
  return cases::read_case(cases_path + file);
}

compare::Comparison solve_and_judge(const Case& definition) {
  return compare::compare_case(definition);
}

const compare::Gate* first_missed(const compare::Comparison& judged) {
  for (const compare::Gate& gate : judged.gates)
    if (!gate.met()) return &gate;
  return nullptr;
}

void give_springs(Case& definition, const std::array<double, 3>& newtons_per_metre) {
  definition.msm = {};
  definition.msm.design = cases::Design::given;
  definition.msm.stiffness = newtons_per_metre;
}

void swap_axes(Case& definition) {
  for (cases::Load& load : definition.loads) {
    Eigen::Vector3d& force = std::get<cases::loads::Traction>(load.kind).value;
    std::swap(force.x(), force.z());
  }
}

cases::measures::Tilt& tilt(Case& definition, const std::string& name) {
  for (cases::Measure& m : definition.measures)
    if (m.name == name) return std::get<cases::measures::Tilt>(m.kind);
  throw std::logic_error("no measure " + name);
}

/// What is done to a case before it is solved.
struct Mutant {
  std::string what;
  std::string file;
  std::function<void(Case&)> mutate;
};

const std::vector<Mutant> mutants{
    {"the sign of k_f", "gates/uniaxial_exact.toml",
     [](Case& c) {
       give_springs(c, {31, -47, 33});
     }},
    {"dropped face springs", "gates/uniaxial_exact.toml",
     [](Case& c) {
       give_springs(c, {31, 0, 33});
     }},
    {"swapped axes", "gates/uniaxial_exact.toml", swap_axes},
    {"halved force", "gates/small_strain_exact.toml", [](Case& c) { c.loads[0].scale(0.5); }},
    {"halved force far from rest", "gates/sheared_cube.toml", [](Case& c) { c.loads[0].scale(0.5); }},
    {"alpha measured on the wrong edge", "gates/sheared_cube.toml",
     [](Case& c) { tilt(c, "alpha_1") = tilt(c, "alpha_2"); }},
    {"B-bar off", "gates/sheared_cube.toml", [](Case& c) { c.fem.element = cases::Element::q1; }},
    {"a tilt towards the wrong axis", "gates/sheared_cube.toml",
     [](Case& c) { tilt(c, "alpha_2").toward = cases::Axis::y; }},
    {"another law", "gates/calculix_cube.toml",
     [](Case& c) { c.fem.formulation = cases::Formulation::log_strain; }},
    {"renamed measure", "gates/calculix_cube.toml", [](Case& c) { c.measures[0].name = "alpha_left"; }},
    {"expectations lost", "gates/calculix_cube.toml", [](Case& c) { c.expectations.clear(); }},
};

/// What is done to the answers of a solved case.
struct Drift {
  std::string what;
  std::function<void(Comparison&)> drift;
};

void scale(cases::Solution& solution, double factor) {
  for (Eigen::Vector3d& u : solution.displacement) u *= factor;
}

const std::vector<Drift> drifts{
    {"springs that drift by a thousandth", [](Comparison& c) { scale(c.answers.msm.solution, 1.001); }},
    {"a reference that drifts by a thousandth", [](Comparison& c) { scale(c.answers.fem.solution, 0.999); }},
    {"a stale baseline",
     [](Comparison& c) { // by two per cent: the case has changed since, and its intervals have not
       for (auto& e : c.scene.definition.expectations)
         if (e.reference == cases::ReferenceKind::regression)
           for (double& end : e.interval) end *= 1.02;
     }},
    {"springs that answer nothing at all", [](Comparison& c) { scale(c.answers.msm.solution, 0); }},
    {"a displacement that is not a number",
     [](Comparison& c) { scale(c.answers.msm.solution, std::numeric_limits<double>::quiet_NaN()); }},
};

} // namespace

TEST_CASE("the gates that come with the program are met by the program", "[long]") {
  for (const char* file : {"gates/uniaxial_exact.toml", "gates/small_strain_exact.toml",
                           "gates/sheared_cube.toml", "gates/calculix_cube.toml"}) {
    const auto judged = solve_and_judge(read(file));
    INFO(file);
    for (const compare::Gate& gate : judged.gates) {
      INFO(describe(gate));
      CHECK(gate.met());
    }
    CHECK(judged.met());
  }
}

TEST_CASE("every mutant of a case turns a gate red", "[long]") {
  for (const Mutant& mutant : mutants) {
    INFO(mutant.what);
    Case definition = read(mutant.file);
    mutant.mutate(definition);
    const auto judged = solve_and_judge(definition);
    CHECK_FALSE(judged.met());
    CHECK((first_missed(judged) || !judged.failures().empty()));
  }
}

TEST_CASE("every drift of a solved case's numbers turns a gate red") {
  const Comparison solved = compare::compare_case(read("gates/sheared_cube.toml"));
  CHECK(solved.met());
  for (const Drift& drift : drifts) {
    INFO(drift.what);
    Comparison drifted = solved;
    drift.drift(drifted);
    drifted = compare::comparison_of(drifted.scene, drifted.answers);
    CHECK(first_missed(drifted));
  }
}
