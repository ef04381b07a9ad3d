#include "compare/solve/side_bytes.hpp"

#include "compare/solve/bytes.hpp"

namespace springproof::compare {

template<class Archive>
void transfer(Archive& archive, Side& side) {
  transfer_all(archive, side.solution, side.setup_seconds, side.solve_seconds);
}

template<class Archive>
void transfer(Archive& archive, msm::DesignResult& design) {
  transfer_all(archive, design.stiffness, design.residual, design.moduli, design.warnings, design.cells);
}

template<class Archive>
void transfer(Archive& archive, StudiedMeasure& measure) {
  transfer_all(archive, measure.name, measure.values, measure.limit, measure.discretisation_error_percent,
               measure.reason);
}

template<class Archive>
void transfer(Archive& archive, MeshStudy& study) {
  transfer_all(archive, study.refine, study.unknowns, study.measures);
}

template<class Archive>
void transfer(Archive& archive, Peer& peer) {
  transfer_all(archive, peer.program, peer.side, peer.largest_difference);
}

template<class Archive>
void transfer_answers(Archive& archive, Comparison& comparison) {
  cases::Fem& fem = comparison.scene.definition.fem; // what "auto" was taken to mean
  transfer_all(archive, comparison.fem, comparison.msm, comparison.design, comparison.mesh_study,
               comparison.peer, comparison.choices, fem.formulation, fem.refine);
}

std::string to_bytes(const Comparison& comparison) {
  Writer writer;
  Comparison copy = comparison; // because one transfer() serves both directions
  transfer_answers(writer, copy);
  return writer.bytes;
}

void from_bytes(const std::string& bytes, Comparison& comparison) {
  Reader reader(bytes);
  transfer_answers(reader, comparison);
  if (!reader.at_end()) throw std::runtime_error("a stored answer is too long");
}

} // namespace springproof::compare
