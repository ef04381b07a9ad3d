#pragma once

#include "cases/mesh/sharing.hpp"

#include <memory>
#include <mpi.h>

namespace springproof::mechanics {

/// A process alone need not start MPI, and then must not ask it anything.
bool is_mpi_started();

/// Answers on a mesh, shared by the ranks of a communicator; null where there is but one,
/// or MPI has not been started. Collective.
std::shared_ptr<const cases::Sharing> share_out(const cases::Mesh& mesh, MPI_Comm communicator);

} // namespace springproof::mechanics
