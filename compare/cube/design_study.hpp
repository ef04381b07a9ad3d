#pragma once

#include "compare/cube/cube_benchmark.hpp"
#include "msm/design/design.hpp"
#include "msm/design/homogeneous.hpp"

#include <optional>
#include <string>
#include <vector>

/// Designs side by side: what each method answers, how far its lattice is stable, and how well the cube does
/// with it.
namespace springproof::compare {

struct DesignAttempt {
  std::string name;
  std::optional<msm::DesignResult> design;
  std::string refusal{};                          ///< why there is no design
  std::optional<msm::StabilityRange> stability{}; ///< of a cubical cell's lattice
  std::optional<CubeErrors> cube{};               ///< when measured
};

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

/// Smaller of the logarithmic strains to which a lattice can be stretched and compressed.
double stable_strain(const msm::StabilityRange& range);

/// Whether no other attempt has both a smaller worst error and a larger stable strain. Attempts that were not
/// measured never are.
std::vector<bool> on_pareto_front(const std::vector<DesignAttempt>& attempts);

} // namespace springproof::compare
