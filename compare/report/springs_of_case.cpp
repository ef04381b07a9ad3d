#include "compare/report/springs_of_case.hpp"

#include "cases/case/names.hpp"
#include "compare/cube/write_design.hpp"
#include "compare/write/json.hpp"

namespace springproof::compare {

namespace {

/// The lattice's limits of stability, which are known of cubes of four stiffnesses.
std::optional<msm::StabilityRange> stability_of(const cases::HexMesh& mesh, const msm::DesignResult& design) {
  const double edge = msm::cube_edge(cases::cell_vertices(mesh, 0));
  if (!(edge > 0) || !design.is_of_four_stiffnesses()) return std::nullopt;
  return msm::stability_range(design.stiffness, edge);
}

/// Kinds of cells that differ; 0 where all are alike, and of a network.
std::size_t n_kinds(const msm::SpringBody& springs) {
  if (springs.terms()) return springs.terms()->kinds.size();
  return springs.cells() && springs.cells()->size() > 1 ? springs.cells()->size() : 0;
}

} // namespace

nlohmann::ordered_json springs_of_case(const Comparison& comparison) {
  const auto& design = comparison.answers.design;
  if (!design || !comparison.answers.msm_source.empty()) return nullptr;
  const cases::Msm& options = comparison.scene.definition.msm;
  const bool is_network = options.design == cases::Design::network;
  DesignAttempt attempt{cases::name_of(options.design), design};
  attempt.options = options;
  if (!is_network) attempt.stability = stability_of(comparison.scene.mesh, *design);
  nlohmann::ordered_json document = attempt_to_json(attempt);
  document["design"] = attempt.name;
  document["kinds_of_cells"] = n_kinds(design->springs);
  if (is_network) document["moduli"] = nullptr;
  return document;
}

} // namespace springproof::compare
