#pragma once

#include "cases/mesh/vtk.hpp"
#include "compare/gates/comparison.hpp"

#include <ostream>

namespace springproof::compare {

/// The body's mesh as a VTK unstructured grid (.vtu, raw binary) with the displacements and cell volumes of
/// the sides that converged, and their difference: ParaView's "warp by vector" overlays both models. Doubles,
/// mm and mm³. Where ranks share the answers, this rank's cells with their nodes.
void write_vtu(std::ostream& out, const Comparison& comparison);

/// Any vectors on a mesh's nodes as a .vtu.
void write_vtu(std::ostream& out, const cases::HexMesh& mesh, const std::vector<cases::PointField>& fields);

/// The same as files: FOLDER/NAME.vtu or, where ranks share the answers, FOLDER/NAME_pieces/NAME_RANK.vtu and
/// FOLDER/NAME.pvtu, which is written when its pieces are whole. What other numbers of ranks have left is
/// removed. Every rank calls it.
/// @throws InputError if a file cannot be written
void write_fields(const std::string& folder, const Comparison& comparison);

} // namespace springproof::compare
