#include "compare/solve/solvers.hpp"
#include "fem_reference/session.hpp"
#include "msm/snes/snes.hpp"

#include <dlfcn.h>
#include <mpi.h>

// The table of the shared object springproof_solvers, over fem_reference, msm/snes and mechanics/petsc.
namespace springproof::compare {

namespace {

/// Lets everybody see Open MPI's functions, which the parts that it loads look for; Python would hide them.
void show_mpi() {
  Dl_info mpi{};
  if (dladdr(reinterpret_cast<const void*>(&MPI_Init), &mpi) != 0)
    dlopen(mpi.dli_fname, RTLD_LAZY | RTLD_GLOBAL | RTLD_NOLOAD);
}

std::shared_ptr<void> start() {
  show_mpi();
  return std::make_shared<fem_reference::Session>();
}

} // namespace

const SolverFunctions springproof_solvers{
    start,
    [](const cases::Scene& scene, fem_reference::Backend backend) {
      return std::make_unique<fem_reference::Model>(scene, MPI_COMM_WORLD, backend);
    },
    [](const cases::Scene& scene) {
      return fem_reference::follow(scene, fem_reference::default_steps(), fem_reference::Backend::automatic,
                                   MPI_COMM_WORLD);
    },
    fem_reference::vibrating_body,
    [](const cases::Scene& scene, const msm::SpringBody& springs) {
      return msm::solve_by_snes(scene, springs, MPI_COMM_WORLD);
    },
    mechanics::petsc::lowest_spectrum,
    mechanics::petsc::lowest_vibrations};

} // namespace springproof::compare
