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

std::string to_bytes(const Comparison& comparison) {
  Writer writer;
  Side fem = comparison.fem, msm = comparison.msm; // copies, because one transfer() serves both directions
  std::optional<msm::DesignResult> design = comparison.design;
  transfer(writer, fem);
  transfer(writer, msm);
  transfer(writer, design);
  return writer.bytes;
}

void from_bytes(const std::string& bytes, Comparison& comparison) {
  Reader reader(bytes);
  transfer(reader, comparison.fem);
  transfer(reader, comparison.msm);
  transfer(reader, comparison.design);
  if (!reader.at_end()) throw std::runtime_error("a worker's answer is too long");
}

} // namespace compare
