#pragma once

#include "fem_reference/model.hpp"
#include "mechanics/petsc/spectrum.hpp"
#include "mechanics/vibrating_body.hpp"
#include "msm/snes/snes.hpp"

#include <memory>

namespace springproof::compare {

/// All that needs deal.II, PETSc or SLEPc: the functions of the shared object springproof_solvers. Loading
/// these libraries takes a third of a second, for which nothing else has to wait.
struct SolverFunctions {
  /// Starts MPI, PETSc and SLEPc. They end with what is returned.
  std::shared_ptr<void> (*start)();
  std::unique_ptr<fem_reference::Model> (*finite_elements)(const cases::Scene&, fem_reference::Backend);
  cases::Solution (*follow_finite_elements)(const cases::Scene&);
  mechanics::VibratingBody (*vibrating_elements)(const cases::Scene&);
  cases::Solution (*solve_by_snes)(const cases::Scene&, const msm::SpringBody&);
  mechanics::Spectrum (*lowest_spectrum)(Eigen::SparseMatrix<double>, int n_pairs);
  mechanics::Spectrum (*lowest_vibrations)(Eigen::SparseMatrix<double> stiffness,
                                           Eigen::SparseMatrix<double> mass, int n_pairs);
};

/// The symbol by which solvers() finds them.
extern "C" const SolverFunctions springproof_solvers;

/// Loads and starts them at the first call, which is collective under an MPI launcher; they end with the
/// process.
/// @throws InputError if PETSC_OPTIONS has an option that is not allowed, or for want of address space;
/// std::system_error if they cannot be loaded
const SolverFunctions& solvers();

/// The finite elements of a scene.
inline std::unique_ptr<fem_reference::Model>
make_finite_elements(const cases::Scene& scene,
                     fem_reference::Backend backend = fem_reference::Backend::automatic) {
  return solvers().finite_elements(scene, backend);
}

/// PETSc takes its options from the environment variable PETSC_OPTIONS; the program's own arguments are not
/// PETSc's.  @throws InputError if they have one that is not allowed; PETSc gets none of them
void check_petsc_options();

} // namespace springproof::compare
