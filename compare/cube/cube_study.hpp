#pragma once

#include "compare/gates/comparison.hpp"

#include <string>
#include <vector>

/// The thesis's cube as a touchstone of designs: one finite-element answer, many mass-spring ones.
namespace springproof::compare {

enum class LoadSets { small, small_and_large };

/// The cube's tests solved with finite elements: linear elasticity at small strain (small set) and with log
/// strain (large set), both with B-bar; Ogden with q1_p0.
struct CubeReference {
  std::vector<Comparison> tests; ///< the finite-element side alone; the case's name tells the test
};

/// Collective over MPI_COMM_WORLD.  @throws InputError for a material that the formulations refuse
CubeReference solve_cube_reference(const cases::Material& material, LoadSets sets);

/// A measure of a test, or the test's failure (no error_percent).
struct CubeError {
  std::string test; ///< "cube-shear-small", ...
  std::string measure;
  std::optional<double> error_percent;
  std::string message; ///< why there is none
};

struct CubeErrors {
  std::vector<CubeError> measures; ///< the volume too
  bool is_stable = true; ///< every test converged to a positive definite tangent without inverted cells
  std::optional<double>
  worst() const; ///< largest |error| of all measures but the volume; nothing if a test failed
  std::optional<double> worst_volume() const;
};

/// The same tests with a cube of these springs.
CubeErrors cube_errors(const CubeReference& reference, const msm::CellStiffness& stiffness);

} // namespace springproof::compare
