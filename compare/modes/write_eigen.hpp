#pragma once

#include "compare/modes/modes.hpp"

#include <nlohmann/json_fwd.hpp>
#include <ostream>

namespace springproof::compare {

void write_eigenspaces_text(std::ostream& out, const EigenspaceAnalysis& analysis);
void write_free_modes_text(std::ostream& out, const FreeBodyModes& modes);

/// h, fem, msm, equivalent (spaces numbered from 1, as in the thesis) and coupling.
nlohmann::ordered_json eigenspaces_to_json(const EigenspaceAnalysis& analysis);
nlohmann::ordered_json free_modes_to_json(const FreeBodyModes& modes);

/// One panel of a dot diagram.
struct DotDiagram {
  std::string title;
  const EigenspaceAnalysis* analysis;
};

/// Dot diagrams side by side as NAME.csv, .svg and .png (thesis figure 4.11 and appendix A).
void plot_dot_diagrams(const std::string& folder, const std::string& name,
                       const std::vector<DotDiagram>& panels);

/// Writes into a folder the dot diagram of thesis appendix A (dot_diagram.csv, .svg, .png), coupling.csv, and
/// the shapes of all eigenspaces of both cells (fem_modes.vtu, msm_modes.vtu), also as picture sheets
/// (fem_modes.svg, ... ; thesis figures 4.9 and 4.10).
/// @param vertices  vertices of the cell, mm
void write_eigenspaces_files(const std::string& folder, const EigenspaceAnalysis& analysis,
                             const msm::CellVertices& vertices);

/// Writes into a folder the body's modes side by side: body_modes.csv and body_modes.vtu, and their plot.
void write_free_modes_files(const std::string& folder, const FreeBodyModes& modes,
                            const cases::HexMesh& mesh);

void write_vibrations_text(std::ostream& out, const VibrationStudy& study);

/// {"case", "fem_hz", "designs": [{"design", "refusal", "modes": [...]}], "modes": those of the first
/// design}; a mode is {"fem_hz", "multiplicity", "msm_hz", "overlap", "error_percent"}.
nlohmann::ordered_json vibrations_to_json(const VibrationStudy& study);

/// FOLDER/NAME_modes.csv, and FOLDER/NAME_modes.vtu with the shapes that were matched.
/// @throws InputError if a file cannot be written
void write_vibrations_files(const std::string& folder, const VibrationStudy& study,
                            const cases::HexMesh& mesh);

} // namespace springproof::compare
