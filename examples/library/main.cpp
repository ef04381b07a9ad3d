// A block of soft tissue as springs: designed for its Young's modulus and Poisson's ratio, pulled, and
// measured.
#include <cases/case/read_case.hpp>
#include <cases/scene/scene.hpp>
#include <compare/measure/measure.hpp>
#include <compare/solve/springs.hpp>
#include <iostream>
#include <msm/model.hpp>
#include <msm/spring_body.hpp>

using namespace springproof;

int main(int argc, char** argv) try {
  if (argc != 2) throw cases::InputError("usage: pull CASE");
  const cases::Scene scene = cases::make_scene(cases::read_case(argv[1]));

  // Stiffnesses of a cell's edges, face and internal diagonals, and what lattice they make.
  const msm::DesignResult design = compare::design_for(scene);
  std::cout << "k_e, k_f, k_d = " << design.stiffness.edge << ", " << design.stiffness.face_diagonal << ", "
            << design.stiffness.internal_diagonal << " N/mm; E = " << design.moduli.youngs_modulus
            << " MPa, nu = " << design.moduli.poissons_ratio << '\n';

  // Every spring, with its own stiffness, as a simulator takes them.
  const msm::Lattice lattice = msm::make_lattice(scene.mesh, design.springs);
  std::cout << lattice.rest.size() << " points, " << lattice.links.size() << " springs, "
            << lattice.volume_cells.size() << " volume terms\n";

  msm::Model model(scene, design.springs);
  const cases::Solution solution = model.solve();
  for (const cases::Measure& measure : scene.definition.measures)
    std::cout << measure.name << " = " << compare::evaluate(measure, scene, solution) << ' '
              << compare::unit_of(measure) << '\n';
} catch (const std::exception&
             error) { // cases::InputError: what is wrong where; cases::SolveError: why no equilibrium
  std::cerr << error.what() << '\n';
  return 1;
}
