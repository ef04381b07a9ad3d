#pragma once

#include "cases/mesh/sharing.hpp"

#include <memory>
#include <mpi.h>

namespace springproof::mechanics {

/// Answers on a mesh, shared by the ranks of a communicator; null where there is but one. Collective.
std::shared_ptr<const cases::Sharing> share_out(const cases::HexMesh& mesh, MPI_Comm communicator);

} // namespace springproof::mechanics
