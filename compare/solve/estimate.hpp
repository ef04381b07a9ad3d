#pragma once

#include "compare/provenance/machine.hpp"
#include "compare/solve/answers.hpp"

/// What solving takes, before it is begun: from the numbers of nodes, element, formulation and backend alone.
namespace springproof::compare {

struct Estimate {
  std::string model;             ///< "finite elements (matrix-free)"
  double unknowns = 0;           ///< constrained ones included
  double megabytes = 0;          ///< 10^6 bytes above what the program takes by itself
  double seconds = 0;            ///< seconds of one thread, from the model to the equilibrium
  double megabytes_of_each = 0;  ///< part of megabytes that every rank has whole
  bool is_on_first_rank = false; ///< the rest; else all ranks have it together
  std::string remedy = "give the body fewer cells, or refine it less"; ///< where memory is short
};

/// The body of a case, as far as estimates depend on it.
struct BodySize {
  double n_nodes = 0, n_cells = 0;
  cases::Scene outline; ///< the definition and the grid, if the body is one; without nodes
};
BodySize size_of(const cases::Scene& scene);
/// The size of a box, voxels (about) or a labelled volume before the mesh is made; nothing for another body,
/// or where the surface or volume cannot be read.
std::optional<BodySize> size_of(const cases::Case& definition);

/// Estimate of the finite elements, refined as [fem] says.
Estimate estimate_fem(const BodySize& body);
Estimate estimate_springs(const BodySize& body);
/// Estimate of what springs without supports do at rest, whose matrix is factorised.
Estimate estimate_free_springs(const BodySize& body);
/// Estimates of both models' lowest vibrations, whose matrices are factorised.
std::vector<Estimate> estimate_vibrations(const BodySize& body);
/// The models that a question asks for; of finite elements on several meshes, one for each.
std::vector<Estimate> estimate(const BodySize& body, const Request& request);
std::vector<Estimate> estimate(const Question& question);

/// Sum of all models, one after the other.
double total_seconds(const std::vector<Estimate>& models);
/// Memory of the largest model: one is gone before the next is made.
double most_megabytes(const std::vector<Estimate>& models);

/// A line with the unknowns, memory and time of each model; empty for a solve of less than ten seconds.
std::string long_solve_text(const std::string& name, const std::vector<Estimate>& models);

struct RanksOfMachine {
  int all = 1, here = 1;
};
RanksOfMachine ranks_of_machine();

/// The part of a model's memory that a limit is for: of one machine's ranks, or of one rank.
double megabytes_within(const MemoryLimit& limit, const Estimate& model,
                        const RanksOfMachine& ranks = ranks_of_machine());

/// @param file  file of the case
/// @throws InputError if a model needs more memory than there is, with what it needs, the limit and a remedy
void check_memory(const std::string& file, const std::vector<Estimate>& models, const MemoryLimit& limit);

/// The scene of a case whose mesh there is memory for.  @throws InputError as check_memory() and make_scene()
cases::Scene make_scene_within_memory(const cases::Case& definition);

/// Checks every question before any is solved.
void check_memory(const std::vector<Question>& questions);

/// How many of the questions can be solved at the same time.
/// @param megabytes  one per question   @return at least 1, at most n_workers
int workers_within(const MemoryLimit& limit, std::vector<double> megabytes, int n_workers);

} // namespace springproof::compare
