#pragma once

#include "cases/mesh/labels.hpp"

namespace springproof::cases {

/// Puts the points and directions of a case in its picture's world coordinates into those of the body: x, y,
/// z along the axes of the picture's array, from its corner. Other cases stay as they are.
/// @param remarks  receives how the body lies in the world
/// @return how it does, for such a case
/// @throws InputError if the picture has no such coordinates, or if the case has a box or a displacement
/// along axes of the world that needs those of the array
std::optional<Placement> leave_world(Case& definition, std::vector<std::string>& remarks);

} // namespace springproof::cases
