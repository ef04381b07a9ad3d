#pragma once

#include "cases/mesh/vtk_functions.hpp"
#include "compare/gates/comparison.hpp"

#include <ostream>

namespace springproof::compare {

/// The body's mesh at rest with grid_fields_of() the comparison as a VTK unstructured grid (.vtu, doubles,
/// raw binary), for ParaView. Every array carries its unit as VTK's UNITS_LABEL; tensors have the components
/// XX, YY, ZZ, XY, YZ, XZ. All of the answers is here: no ranks share them.
void write_vtu(std::ostream& out, const Comparison& comparison);

/// Any vectors on a mesh's nodes as a .vtu.
void write_vtu(std::ostream& out, const cases::HexMesh& mesh, const std::vector<cases::PointField>& fields);

/// Removes FOLDER/NAME_NUMBER.vtu of this number and above, of an earlier run, and the folder if nothing is
/// left.
void remove_numbered(const std::string& folder, const std::string& name, int first);

/// The same as files: FOLDER/NAME.vtu or, where ranks share the answers, FOLDER/NAME_pieces/NAME_RANK.vtu and
/// FOLDER/NAME.pvtu, which is written when its pieces are whole; and FOLDER/NAME_springs.vtu, the springs as
/// lines, where has_drawn_springs(). What other numbers of ranks have left is removed. Every rank calls it.
/// @throws InputError if a file cannot be written
void write_fields(const std::string& folder, const Comparison& comparison);

} // namespace springproof::compare
