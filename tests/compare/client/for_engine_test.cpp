#include "compare/client/for_engine.hpp"

#include "cases/case/error.hpp"
#include "cases/case/read_case.hpp"
#include "compare/solve/springs.hpp"
#include "tests/support/run_program.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <sstream>

using namespace springproof;

using compare::Engine;
using compare::EngineDesign;

namespace {

compare::EngineRequest request_for(Engine engine, double nu = 0.45) {
  msm::DesignRequest design;
  design.material = cases::LinearElastic{0.3, nu};
  design.cell = msm::cube(10);
  return {engine, design};
}

double number_of(const EngineDesign& design, const std::string& name) {
  for (const compare::EngineNumber& one : design.numbers)
    if (one.name == name) return one.value;
  FAIL("no number " + name);
  return 0;
}

std::string text_of(const EngineDesign& design) {
  std::ostringstream out;
  compare::write_engine_design_text(out, design);
  return out.str();
}

/// A client by its command, whose failure is a row.
compare::EngineRequest with_client(compare::EngineRequest request, const std::vector<std::string>& words) {
  request.client = compare::Client{"mine", words};
  return request;
}

} // namespace

TEST_CASE("an engine's springs have the stiffnesses of a lattice's, by the cells that share them") {
  compare::EngineRequest request = request_for(Engine::sofa);
  const EngineDesign design = compare::design_for_engine(request);
  CHECK(design.design == "hybrid");
  CHECK(design.not_run.find("no client of it comes with this program") == 0);
  const cases::Scene scene = cases::make_scene(cases::read_case_text(
      "schema = 1\nname = 'block'\n[body]\nshape = 'box'\nsize = [20, 20, 20]\ncells = [2, 2, "
      "2]\n[material]\n"
      "model = 'linear_elastic'\nyoungs_modulus = 0.3\npoissons_ratio = 0.45\n[[fixed]]\nregion = 'z-'\n"
      "[[load]]\nregion = 'z+'\nkind = 'traction'\nvalue = [0, 0, 0.001]\n"
      "[msm]\ndesign = 'hybrid'\n",
      "block.toml"));
  const msm::Lattice lattice =
      msm::make_lattice(scene.mesh, compare::springs_as_solved(scene, compare::design_for(scene)));
  const auto between = [&](Eigen::Vector3d a, Eigen::Vector3d b) { // N/m
    for (const msm::Link& link : lattice.links)
      if ((lattice.rest[cases::index(link.i)] - a).norm() + (lattice.rest[cases::index(link.j)] - b).norm() <
          1e-9)
        return 1e3 * link.spring.stiffness;
    FAIL("no such spring");
    return 0.;
  };
  const auto is = [](double value) { return Approx(value).epsilon(1e-12); };
  CHECK(number_of(design, "stiffness of an edge of one cell") == is(between({0, 0, 0}, {10, 0, 0})));
  CHECK(number_of(design, "stiffness of an edge of two cells") == is(between({0, 10, 0}, {10, 10, 0})));
  CHECK(number_of(design, "stiffness of an edge of four cells") == is(between({0, 10, 10}, {10, 10, 10})));
  CHECK(number_of(design, "stiffness of a face's diagonal of one cell") ==
        is(between({0, 0, 0}, {10, 10, 0})));
  CHECK(number_of(design, "stiffness of a face's diagonal of two cells") ==
        is(between({0, 0, 10}, {10, 10, 10})));
  CHECK(number_of(design, "stiffness of an internal diagonal") == is(between({0, 0, 0}, {10, 10, 10})));
  CHECK(number_of(design, "k_v of a cell") == is(1e6 * lattice.volume_cells.front().stiffness));

  request.has_method = true;
  request.design.options.design = cases::Design::uniform; // not halved at the boundary
  const EngineDesign uniform = compare::design_for_engine(request);
  CHECK(number_of(uniform, "stiffness of every spring") ==
        is(1e3 * msm::design(request.design).stiffness.internal_diagonal));
  CHECK(std::none_of(uniform.numbers.begin(), uniform.numbers.end(), [](const compare::EngineNumber& one) {
    return one.name == "stiffness of an edge of one cell";
  }));
}

TEST_CASE("numbers of a material with another law say that the beam is linear elastic") {
  const auto says = [](const compare::EngineRequest& request) {
    return text_of(compare::design_for_engine(request)).find("the beam that is judged is linear elastic") !=
           std::string::npos;
  };
  compare::EngineRequest request = request_for(Engine::usd, 0.3);
  CHECK_FALSE(says(request));
  request.design.material = cases::Ogden{{0.1}, {2}, 0.3};
  CHECK(says(request));
}

namespace {

/// Compliances of an engine are those of the same springs' stiffnesses.
/// @param volumes  the name of the volumes' compliance   @param factor  of the volume V that it constrains
void check_compliances(const EngineDesign& inverse, const std::string& volumes, double factor) {
  const auto is = [](double value) { return Approx(value).epsilon(1e-12); };
  const EngineDesign design = compare::design_for_engine(request_for(Engine::sofa));
  CHECK(number_of(inverse, "compliance of an internal diagonal") ==
        is(1 / number_of(design, "stiffness of an internal diagonal")));
  const double rest = 1e-6, change = 0.01 * rest / 3; // m³, of a cell, of a tetrahedron of a third
  CHECK(2 * std::pow(factor * change, 2) / (2 * number_of(inverse, volumes)) ==
        is(number_of(design, "k_v of a cell") / 2 * rest * 0.01 * 0.01)); // the energy C²/(2 alpha)
}

} // namespace

TEST_CASE("compliances store the energy of springs and volumes, and a client that is not there has failed",
          "[verification][long]") {
  const EngineDesign jolt = compare::design_for_engine(with_client(request_for(Engine::jolt), {"/nowhere"}));
  check_compliances(jolt, "compliance of 6 V of an inscribed tetrahedron, two a cell", 6);
  CHECK(jolt.has_failed());
  CHECK_THAT(text_of(jolt), Catch::Contains("mine does not answer: ") && Catch::Contains("/nowhere"));
}

TEST_CASE("the error to expect is found by running: a converged client errs as the springs do",
          "[verification][long]") {
  const EngineDesign design = compare::design_for_engine(
      with_client(request_for(Engine::xpbd),
                  {"/usr/bin/python3", SPRINGPROOF_SOURCE_DIR "/clients/reference/client.py"}));
  check_compliances(design, "compliance of V of an inscribed tetrahedron, two a cell", 1);
  REQUIRE(design.judged);
  const auto& rows = design.judged->rows;
  REQUIRE(rows.size() == 3); // finite elements, springs, the client
  if (rows.back().failure.find("cannot confine a program") != std::string::npos) {
    WARN("nothing was checked: " + rows.back().failure);
    return;
  }
  REQUIRE_FALSE(design.has_failed());
  CHECK(design.judged->is_converged);
  CHECK(*rows[2].worst == Approx(*rows[1].worst).epsilon(1e-6)); // both solve to 1e-9
  CHECK_THAT(text_of(design),
             Catch::Contains(fmt::format("mine: expect an error of {:.3g} %", *rows[2].worst)));
  const compare::Json json = compare::engine_design_to_json(design);
  CHECK(json["judged"]["rows"].size() == 3);
  CHECK(json["not_run"].is_null());
  // The tip goes down by what the weight is for: a slender beam's 7 %, more by shear.
  const compare::MeasuredValue* tip = compare::find_named(rows[0].measures, "tip");
  REQUIRE(tip);
  CHECK((*tip->fem / -100 > 0.06 && *tip->fem / -100 < 0.09));
}

TEST_CASE("an engine takes moduli, or the springs that it can have") {
  const EngineDesign usd = compare::design_for_engine(request_for(Engine::usd));
  CHECK(number_of(usd, "physxDeformableBodyMaterial:youngsModulus") == Approx(3e5));
  CHECK(compare::engine_design_to_json(usd)["judged"].is_null());
  CHECK_THAT(text_of(usd), Catch::Contains("error: not run: no client of it"));
  CHECK(compare::design_for_engine(request_for(Engine::unity, 0.25)).design == "moduli"); // no volume term

  const auto refuses = [](compare::EngineRequest request, const std::string& message) {
    CHECK_THROWS_WITH(compare::design_for_engine(request), Catch::Contains(message));
  };
  compare::EngineRequest named = request_for(Engine::jolt);
  named.has_method = true;
  named.design.options.design = cases::Design::midline;
  refuses(named, "--for jolt cannot have springs of the method midline");
  named.engine = Engine::rapier;
  refuses(named, "--for rapier takes E and nu, and no springs of a method");
  compare::EngineRequest incompressible = request_for(Engine::jolt);
  incompressible.design.material = cases::Ogden{{0.1}, {2}, std::nullopt};
  refuses(incompressible, "must have nu below 0.5");
  incompressible.design.material = cases::LinearElastic{0.3, 0.3};
  for (Eigen::Vector3d& vertex : incompressible.design.cell) vertex.z() *= 2;
  refuses(incompressible, "the cell is no cube along the axes");
}

TEST_CASE("the command prints an engine's numbers, and refuses options that have no meaning with them") {
  const ProgramRun usd = run_program("design --young 0.3 --poisson 0.45 --for usd --json");
  CHECK(usd.status == 0);
  CHECK(nlohmann::json::parse(usd.out)["numbers"][1]["value"] == 0.45);
  check_refused("design --young 0.3 --poisson 0.45 --step 0.01", "--for");
  check_refused("design --young 0.3 --poisson 0.45 --for usd --compare", "--compare");
  check_refused("design --young 0.3 --poisson 0.45 --for doom", "--for");
}
