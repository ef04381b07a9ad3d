#pragma once

#include "cases/scene/scene.hpp"

/// Cuts and what moves with them: pieces removed from a body, their sides joined, motions that fade out.
namespace springproof::cases {

/// A mesh without the pieces that are cut out of it.
/// @throws InputError, at the piece, if the mesh is no grid of cells or has groups of nodes, if a piece has
/// no cells or one that another has too, and if the rest is not one body whose cells hang together by faces
HexMesh cut(HexMesh mesh, const std::vector<Removed>& removed);

/// The first piece whose sides are joined, if there is one.
std::optional<Removed> first_joined(const Case& definition);

/// Closes the cuts that are to be joined: the nodes on both sides of the piece get a prescribed displacement
/// along the axis, that of the side's nodes that are held or moved already (the bone's), so that the sides
/// meet in one plane. There they stay, free to slide: where both sides are mirror images of each other, that
/// is as if their nodes were merged. Nodes of cells that are left between the sides stay free: a cell that
/// such a node was joined in would be shut.
/// @param scene  with its supports resolved
/// @throws InputError, at the piece, if it has nothing on one side, if nothing says how a side moves, or if
/// the sides do not meet
void join_cuts(Scene& scene);

/// @throws InputError, at the motion, if no node lies in the zone that is scaled, or none beyond it
void check_scaled(const Scene& scene);

} // namespace springproof::cases
