#include "msm/direct/patched_system.hpp"

#include "msm/design/by_shape.hpp"
#include "msm/direct/direct_system.hpp"
#include "tests/support/bodies.hpp"
#include "tests/support/tetrahedra.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace springproof;

using msm::Vector;

namespace {

/// A sheared box of tetrahedra with fitted springs, held at its nodes of z = 0 and pressed at all others.
msm::Problem pressed_box(double poissons_ratio, double force) {
  msm::Problem problem;
  problem.mesh = bodies::box_of_tetrahedra({3, 3, 3});
  const auto moduli = mechanics::elastic_moduli(cases::LinearElastic{0.3, poissons_ratio});
  const std::vector<mechanics::ElasticModuli> of_cells(problem.mesh.cells.size(), moduli);
  msm::BodyTerms terms{msm::fit_by_shape(problem.mesh, {of_cells, 0.8}).cells};
  for (std::size_t c = 0; c < terms.kinds.size(); ++c) terms.kind_of_cell.push_back(static_cast<int>(c));
  problem.lattice = msm::make_lattice(problem.mesh, terms);
  for (std::size_t p = 0; p < problem.lattice.rest.size(); ++p) {
    const bool is_held = problem.lattice.rest[p].z() == 0;
    problem.is_constrained.insert(problem.is_constrained.end(), 3, is_held);
    if (!is_held) problem.force.push_back({static_cast<int>(p), {0.3 * force, 0, -force}});
  }
  return problem;
}

} // namespace

TEST_CASE("volume terms at nodes have the same equilibrium by conjugate gradients as factorised",
          "[verification]") {
  const double poissons_ratio = GENERATE(0.3, 0.45, 0.499);
  const msm::Problem problem = pressed_box(poissons_ratio, 0.004);
  REQUIRE(msm::takes_patched_system(problem.lattice));
  const auto direct = msm::make_direct_system(problem), iterated = msm::make_patched_system(problem);
  const Vector rest = Vector::Zero(direct->load().size());
  mechanics::EquilibriumSettings settings;
  settings.tolerance = 1e-11;
  const Vector expected = mechanics::find_equilibrium(*direct, rest, "springs", settings).state;
  const Vector found = mechanics::find_equilibrium(*iterated, rest, "springs", settings).state;
  CHECK(expected.cwiseAbs().maxCoeff() > 0.1); // 3 % of the height: far from linear
  CHECK((found - expected).norm() <
        1e-8 * expected.norm()); // the residual's 1e-11 times the condition number
  CHECK(iterated->work().linear_iterations > 0);
  CHECK(iterated->is_stable(found) == true);
}

TEST_CASE("conjugate gradients of volume terms at nodes have the exact tangent under pressure",
          "[verification]") {
  const msm::Problem problem = pressed_box(0.45, 0.004);
  const auto direct = msm::make_direct_system(problem), iterated = msm::make_patched_system(problem);
  const Vector rest = Vector::Zero(direct->load().size()), &force = direct->load();
  const Vector at = mechanics::find_equilibrium(*direct, rest, "springs").state; // pressed
  const auto solve = [&](msm::SpringSystem& system, mechanics::Convexity convexity) {
    return system.direction(at, force, 1, 1e-12, convexity).value();
  };
  const Vector exact = solve(*direct, mechanics::Convexity::exact),
               clamped = solve(*direct, mechanics::Convexity::clamped);
  CHECK((exact - clamped).norm() > 1e-3 * exact.norm()); // pressure is felt
  // 1e-12 of the forces times the condition number
  CHECK((solve(*iterated, mechanics::Convexity::exact) - exact).norm() < 1e-8 * exact.norm());
  CHECK((solve(*iterated, mechanics::Convexity::clamped) - clamped).norm() < 1e-8 * clamped.norm());
}

TEST_CASE("conjugate gradients of volume terms at nodes tell an unstable lattice, and a mode that falls") {
  const msm::Problem problem = pressed_box(0.45, 0.004);
  const auto direct = msm::make_direct_system(problem), iterated = msm::make_patched_system(problem);
  Vector at(direct->load().size());
  for (Eigen::Index d = 0; d < at.size(); ++d)
    at[d] = 0.6 * std::sin(1.7 * double(d)); // cells turn inside out
  CHECK(direct->is_stable(at) == false);
  CHECK(iterated->is_stable(at) == false);
  const auto mode = iterated->lowest_mode(at);
  REQUIRE(mode);
  CHECK(mode->eigenvalue < 0);
}

TEST_CASE("springs that need their volume terms, and terms that push, are left to the factorised tangent") {
  msm::Problem problem = pressed_box(0.3, 1e-4);
  msm::Problem pushing = problem;
  pushing.lattice.volume_patches[3].stiffness = -1e-3;
  CHECK_FALSE(msm::takes_patched_system(pushing.lattice));
  problem.lattice.links.clear();
  CHECK(msm::make_patched_system(problem)->rest_state() == mechanics::RestState::mechanism);
}
