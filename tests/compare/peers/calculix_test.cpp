// CalculiX's files, and (label peer, which needs ccx) its answers against our finite elements.

#include "compare/peers/calculix.hpp"

#include "cases/case/read_case.hpp"
#include "compare/solve/solvers.hpp"
#include "tests/support/largest.hpp"
#include "tests/support/scene_in_tetrahedra.hpp"

#include <catch2/catch.hpp>
#include <cstdlib>
#include <numeric>
#include <sstream>

using namespace springproof;

using namespace compare;
using Eigen::Vector3d;

namespace {

cases::Case cube(const std::string& test, const std::vector<std::string>& settings) {
  std::vector<std::string> all{"fem.element=q1"};
  all.insert(all.end(), settings.begin(), settings.end());
  return cases::read_case(
      std::string(SPRINGPROOF_SOURCE_DIR) + "/cases/thesis/linear_elastic/cube_" + test + ".toml", all);
}

std::string input_of(const cases::Case& definition) {
  std::ostringstream out;
  write_calculix_input(out, cases::make_scene(definition));
  return out.str();
}

/// Largest difference of a node's displacement from the peer's, relative to that node's own. Nodes that
/// symmetry keeps where they are (on the axis of the torsion) move by rounding errors alone, and differ by
/// those.
double largest_relative_difference(const cases::Solution& ours, const cases::Solution& peer) {
  double largest = 0, size_of_all = 0;
  for (const Vector3d& u : ours.displacement) size_of_all = larger(size_of_all, u.norm());
  for (std::size_t n = 0; n < ours.displacement.size(); ++n) {
    const double size = ours.displacement[n].norm();
    const double difference = (ours.displacement[n] - peer.displacement[n]).norm();
    if (!(difference <= 1e-12 * size_of_all)) largest = larger(largest, difference / size);
  }
  return largest;
}

void check_agrees(const cases::Case& definition) {
  if (std::system("command -v ccx >/dev/null 2>&1") != 0) {
    WARN("CalculiX (ccx) is not installed: nothing was compared");
    return;
  }
  const cases::Scene scene = tetrahedra::make_scene(definition);
  const cases::Solution peer = solve_with_calculix(scene);
  REQUIRE(peer.status == cases::Status::converged);
  const cases::Solution ours = compare::make_finite_elements(scene)->solve();
  INFO(definition.name);
  // the bound asked for; CalculiX prints seven digits of each component
  CHECK(largest_relative_difference(ours, peer) <= 1e-5);
  if (definition.fem.element == cases::Element::p2) return; // volumes of quadratic cells are not read
  const auto total = [](const std::vector<double>& volumes) {
    return std::accumulate(volumes.begin(), volumes.end(), 0.0);
  };
  CHECK(total(peer.cell_volume) ==
        Approx(total(ours.cell_volume)).epsilon(1e-6)); // the digits of the displacements
}

} // namespace

TEST_CASE("nothing of a case's name gets into CalculiX's input") {
  cases::Case definition = cube("tensile_small", {"fem.formulation=small_strain"});
  definition.name = "*STEP";
  const std::string input = input_of(definition);
  CHECK(input.find("*STEP") == input.rfind("*STEP"));
  definition.name = "*INCLUDE, INPUT=x";
  CHECK(input_of(definition) == input);
}

TEST_CASE("a cell of CalculiX's input goes around its bottom, then around its top") {
  cases::Case definition =
      cube("tensile_small", {"body.cells=[1, 1, 1]", "body.size=[1, 2, 3]", "fem.formulation=small_strain"});
  definition.measures.clear(); // they are of the cube of 10 mm
  const std::string input = input_of(definition);
  CHECK_THAT(input, Catch::Contains("*ELEMENT, TYPE=C3D8, ELSET=EALL\n1, 1, 2, 4, 3, 5, 6, 8, 7\n"));
  CHECK_THAT(input, Catch::Contains("\n8, 1.000000000000e+00, 2.000000000000e+00, 3.000000000000e+00\n"));
  // forces in millionths of a newton, moduli to match
  CHECK_THAT(input, Catch::Contains("*ELASTIC\n3.000000000000e+05, 3.500000000000e-01\n"));
  CHECK_THAT(input, Catch::Contains("*BOUNDARY\n1, 1, 1\n1, 2, 2\n1, 3, 3\n2, 1, 1\n"));
  CHECK_THAT(input, Catch::Contains("*CLOAD\n5, 3, 1.000000000000e+04\n6, 3,"));
  CHECK_THAT(input, !Catch::Contains("NLGEOM"));
  definition.fem.formulation = cases::Formulation::saint_venant_kirchhoff;
  CHECK_THAT(input_of(definition), Catch::Contains("*STEP, NLGEOM"));
}

TEST_CASE(
    "what CalculiX has no equal element for is skipped with the reason, before any search for the program") {
  const cases::Case bbar = cube("tensile_small", {"fem.formulation=small_strain", "fem.element=q1_bbar"});
  const cases::Solution solution = solve_with_calculix(cases::make_scene(bbar));
  CHECK(solution.status == cases::Status::skipped);
  CHECK_THAT(solution.message, Catch::Contains("small_strain with q1_bbar"));
  CHECK(reason_without_calculix(cube("tensile_small", {"fem.formulation=log_strain"})).has_value());
  CHECK_FALSE(
      reason_without_calculix(cube("tensile_small", {"fem.formulation=saint_venant_kirchhoff"})).has_value());
  cases::Case fibrous = cube("tensile_small", {"fem.formulation=small_strain", "fem.element=q1"});
  fibrous.material = cases::TransverselyIsotropic{0.3, 0.1, 0.4, 0.5, 0.05, Eigen::Vector3d::UnitZ()};
  CHECK(reason_without_calculix(fibrous) == "its input has isotropic materials");
}

TEST_CASE("the last displacements of a .dat file are read, and zeros with exponents of three digits") {
  std::istringstream dat(R"(
 displacements (vx,vy,vz) for set NALL and time  0.2500000E+00

         1  9.000000E+00  9.000000E+00  9.000000E+00
         2  9.000000E+00  9.000000E+00  9.000000E+00

 displacements (vx,vy,vz) for set NALL and time  0.1000000E+01

         2 -1.250000E-01  1.234567-101  3.000000E+02
         1  0.000000E+00  0.000000E+00 -4.500000E-10
)");
  const CalculixOutput output = read_calculix_blocks(dat, 2).back();
  CHECK(output.load_reached == 1);
  CHECK(output.displacement[0] == Vector3d(0, 0, -4.5e-10));
  CHECK(output.displacement[1] == Vector3d(-0.125, 0, 300));
}

TEST_CASE("a .dat file with a node missing is refused") {
  const std::string heading = " displacements (vx,vy,vz) for set NALL and time  0.1000000E+01\n\n";
  std::istringstream one(heading + "         1  0.000000E+00  0.000000E+00 -4.500000E-10\n"), none("");
  CHECK_THROWS_AS(read_calculix_blocks(one, 2), cases::SolveError);
  CHECK_THROWS_AS(read_calculix_blocks(none, 2), cases::SolveError);
}

TEST_CASE("small strain on the cube agrees with CalculiX on every node", "[peer]") {
  for (const char* test : {"tensile", "shear", "torsion"})
    for (const char* set : {"small", "large"})
      check_agrees(cube(std::string(test) + "_" + set, {"fem.formulation=small_strain"}));
}

TEST_CASE("tetrahedra agree with CalculiX's C3D4 and C3D10 on every node", "[peer]") {
  for (const char* element : {"p1", "p2"})
    for (const char* formulation : {"small_strain", "saint_venant_kirchhoff"})
      for (const char* test : {"shear_small", "torsion_large"}) {
        cases::Case definition = cube(test, {std::string("fem.formulation=") + formulation,
                                             std::string("fem.element=") + element, "body.cells=[3,3,4]"});
        definition.measures.clear(); // volumes of quadratic cells are not read
        check_agrees(definition);
      }
}

TEST_CASE("a bar that is loaded at once moves as CalculiX says, at equal steps of newmark", "[peer]") {
  cases::Case definition = cube("shear_small", {"fem.formulation=small_strain", "body.cells=[3,3,4]"});
  definition.measures.clear(); // a volume is among them
  definition.expectations.clear();
  definition.material_dynamics.density = 1000;
  definition.loads[0].history.points = {{{0., 1.}}, {{0.008, 1.}}, {{0.012, 0.}}};
  definition.dynamics.emplace();
  definition.dynamics->step = 2e-4;
  definition.dynamics->end = 0.02;
  REQUIRE_FALSE(reason_without_calculix(definition));
  const cases::Scene scene = cases::make_scene(definition);
  const std::vector<CalculixOutput> theirs = motion_by_calculix(scene);
  if (theirs.empty()) {
    WARN("CalculiX is not installed: nothing was compared");
    return;
  }
  const cases::Solution ours = solvers().follow_finite_elements(scene);
  const cases::Solution peer = solve_with_calculix(scene);
  REQUIRE(peer.trajectory);
  CHECK(peer.trajectory->time.size() == ours.trajectory->time.size());
  const auto& bodies = ours.trajectory->bodies;
  REQUIRE(bodies.size() == theirs.size() + 1);
  double squared = 0, difference_squared = 0;
  for (std::size_t step = 0; step < theirs.size(); ++step)
    for (std::size_t n = 0; n < theirs[step].displacement.size(); ++n) {
      const Vector3d& u = bodies[step + 1].displacement[n];
      squared += u.squaredNorm();
      difference_squared += (theirs[step].displacement[n] - u).squaredNorm();
    }
  CHECK(squared > 0);
  CHECK(std::sqrt(difference_squared / squared) <= 1e-3);
}

TEST_CASE("Saint Venant-Kirchhoff on the cube agrees with CalculiX's NLGEOM on every node", "[peer][long]") {
  for (const char* test : {"tensile", "shear", "torsion"})
    for (const char* set : {"small", "large"})
      check_agrees(cube(std::string(test) + "_" + set, {"fem.formulation=saint_venant_kirchhoff"}));
}
