#include "compare/solve/solvers.hpp"
#include "fem_reference/motion.hpp"
#include "fem_reference/session.hpp"
#include "fem_reference/vibrating_elements.hpp"
#include "msm/snes/snes.hpp"

#include <dlfcn.h>
#include <mpi.h>

// The one source of the shared object springproof_solvers that callers find; the rest are the libraries of
// fem_reference, msm/snes and mechanics/petsc.
namespace springproof::compare {

namespace {

/// Open MPI loads parts of itself, which look for its functions among those that everybody sees. Python would
/// hide them.
void show_mpi() {
  Dl_info mpi{};
  if (dladdr(reinterpret_cast<const void*>(&MPI_Init), &mpi) != 0)
    dlopen(mpi.dli_fname, RTLD_LAZY | RTLD_GLOBAL | RTLD_NOLOAD);
}

std::shared_ptr<void> start() {
  show_mpi();
  return std::make_shared<fem_reference::Session>();
}

std::unique_ptr<fem_reference::Model> new_model(const cases::Scene& scene, fem_reference::Backend backend) {
  return std::make_unique<fem_reference::Model>(scene, MPI_COMM_WORLD, backend);
}

cases::Solution follow_finite_elements(const cases::Scene& scene) {
  return fem_reference::follow(scene);
}

cases::Solution solve_by_snes(const cases::Scene& scene, const msm::SpringBody& springs) {
  return msm::solve_by_snes(scene, springs, MPI_COMM_WORLD);
}

} // namespace

const SolverFunctions springproof_solvers{start,
                                          new_model,
                                          follow_finite_elements,
                                          fem_reference::vibrating_body,
                                          solve_by_snes,
                                          mechanics::petsc::full_spectrum,
                                          mechanics::petsc::lowest_spectrum,
                                          mechanics::petsc::lowest_vibrations};

} // namespace springproof::compare
