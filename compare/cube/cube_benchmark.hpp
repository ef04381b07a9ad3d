#pragma once

#include "compare/study/study.hpp"
#include "msm/design/cells.hpp"

#include <algorithm>
#include <array>

/// The thesis's cube, on which designs are measured: 10x10x10 cells under tension, shear and torsion, with a
/// small and a large set of loads. `design --measure`, the advice of `tables` and the README's picture all
/// come from here.
///
/// The one reference of every material is what the cube's case files (cases/thesis) declare in [fem], for
/// both load sets:
///   linear elasticity: log_strain with q1_bbar. The springs' law is geometrically nonlinear, so its
///     reference is too; the thesis's table 4.5 is reproduced with it at every Poisson's ratio.
///   Ogden: hyperelastic with q1_p0, its mean-dilatation element (table 5.1).
/// Loads grow with E L0², so that the strains, and with them all errors in percent, depend neither on Young's
/// modulus nor on the cells' edge.
namespace springproof::compare {

/// Reason why springs have no errors from finite elements; empty if they have.
/// @param fem, msm  answers, of which the side of that name is taken
std::string why_without_errors(const Answers& fem, const Answers& msm);

struct CubeTest {
  const char *test, *load_set;
};
inline constexpr std::array<CubeTest, 6> cube_tests{{{"tensile", "small"},
                                                     {"shear", "small"},
                                                     {"torsion", "small"},
                                                     {"tensile", "large"},
                                                     {"shear", "large"},
                                                     {"torsion", "large"}}};

/// A test's case for another material and other cells.  @param edge  a cell's edge, mm, > 0
cases::Case cube_case(const CubeTest& test, const cases::Material& material, double edge);

/// A measure of a test, or the test's failure (no error_percent).
struct CubeError {
  std::string test; ///< "cube-shear-small", ...
  std::string measure;
  std::optional<double> error_percent;
  std::string message; ///< why there is none
};

/// Errors of springs on the cube under one set of loads.
struct LoadSetErrors {
  std::optional<double> worst, mean;  ///< |error|, percent, volumes apart; absent when a test failed
  std::optional<double> worst_volume; ///< worst |error| of volumes, percent
  bool is_stable = true;              ///< every test converged to a stable equilibrium without inverted cells
  std::vector<CubeError> measures{};
  std::size_t worst_test = 0; ///< index in cube_tests
  std::string failure{};      ///< first test without an error, and why; empty when all have one
};

struct CubeErrors {
  LoadSetErrors small, large;
  /// Worst of both load sets; absent when a test failed.
  std::optional<double> worst() const {
    return small.worst && large.worst ? std::max(small.worst, large.worst) : std::nullopt;
  }
  std::optional<double> worst_volume() const {
    return small.worst && large.worst ? std::max(small.worst_volume, large.worst_volume) : std::nullopt;
  }
  bool is_stable() const { return small.is_stable && large.is_stable; }
  /// Ranks by the worst error over both load sets; the first of equal ones is recommended.
  Standing standing() const { return {is_stable() ? worst() : std::nullopt}; }
};

/// @param tests  both sides of each, in the order of cube_tests
CubeErrors cube_errors(const std::vector<Comparison>& tests);

/// What a method answers, how far its lattice is stable, and how well the cube does with it.
struct DesignAttempt {
  std::string name;
  std::optional<msm::DesignResult> design;
  std::string refusal{};                          ///< why there is no design
  std::optional<msm::StabilityRange> stability{}; ///< stable range of a cubical cell's lattice
  std::optional<CubeErrors> cube{};               ///< when measured
  cases::Msm options{};                           ///< what was asked for
  bool has_law_of_cube = false; ///< measured with Hooke's springs, as a case of forces on nodes has them
};

/// A design that was found, with its lattice's stability, which is known of cubes of four stiffnesses.
/// @param cell  mm
DesignAttempt attempt_of(const std::string& name, const msm::DesignResult& design, const cases::Msm& options,
                         const msm::CellVertices& cell);

/// The request's own method.  @throws InputError, SolveError
DesignAttempt attempt_one(const msm::DesignRequest& request);

/// Every method that designs from a material; one that refuses the material is an attempt without a design.
std::vector<DesignAttempt> attempt_all(const msm::DesignRequest& request);

/// Springs alone between accuracy and stability: the moduli method over its split, and the thesis's and the
/// multi-load fits without a volume term.
std::vector<DesignAttempt> attempt_springs(const msm::DesignRequest& request);

/// Solves the cube with every design, of cells like the request's. Collective over MPI_COMM_WORLD.
/// @throws InputError unless the cell is a cube
void measure_on_cube(std::vector<DesignAttempt>& attempts, const msm::DesignRequest& request);

/// The measured attempt that is to be used; null when there is none.
const DesignAttempt* recommended(const std::vector<DesignAttempt>& attempts);

/// Smaller of the logarithmic strains to which a lattice can be stretched and compressed.
double stable_strain(const msm::StabilityRange& range);

/// Whether no other attempt has both a smaller worst error and a larger stable strain. Attempts that were not
/// measured never are.
std::vector<bool> on_pareto_front(const std::vector<DesignAttempt>& attempts);

} // namespace springproof::compare
