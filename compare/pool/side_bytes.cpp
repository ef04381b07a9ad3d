#include "compare/pool/side_bytes.hpp"

#include "compare/pool/bytes.hpp"

namespace compare {

template<class Archive>
void transfer(Archive& archive, Side& side) {
  transfer(archive, side.solution);
  transfer(archive, side.setup_seconds);
  transfer(archive, side.solve_seconds);
}

template<class Archive>
void transfer(Archive& archive, msm::DesignResult& design) {
  transfer(archive, design.stiffness);
  transfer(archive, design.residual);
  transfer(archive, design.moduli);
  transfer(archive, design.warnings);
  transfer(archive, design.cells);
}

template<class Archive>
void transfer(Archive& archive, StudiedMeasure& measure) {
  transfer(archive, measure.name);
  transfer(archive, measure.values);
  transfer(archive, measure.limit);
  transfer(archive, measure.discretisation_error_percent);
  transfer(archive, measure.reason);
}

template<class Archive>
void transfer(Archive& archive, MeshStudy& study) {
  transfer(archive, study.refine);
  transfer(archive, study.unknowns);
  transfer(archive, study.measures);
}

template<class Archive>
void transfer(Archive& archive, Peer& peer) {
  transfer(archive, peer.program);
  transfer(archive, peer.side);
  transfer(archive, peer.largest_difference);
}

template<class Archive>
void transfer_answers(Archive& archive, Comparison& comparison) {
  transfer(archive, comparison.fem);
  transfer(archive, comparison.msm);
  transfer(archive, comparison.design);
  transfer(archive, comparison.mesh_study);
  transfer(archive, comparison.peer);
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

} // namespace compare
