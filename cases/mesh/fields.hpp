#pragma once

#include "cases/mesh/hex_mesh.hpp"
#include "cases/mesh/strict_archive.hpp"
#include "cases/mesh/triangle_mesh.hpp"

#include <cereal/types/array.hpp>
#include <cereal/types/map.hpp>
#include <cereal/types/optional.hpp>
#include <cereal/types/string.hpp>
#include <cereal/types/vector.hpp>
#include <sstream>

/// Values as bytes, to be kept in files or sent to other processes, by cereal. Portable binary and not JSON:
/// displacements keep their last bit, in a third of the bytes. To be included by the few sources that keep or
/// send: cereal is slow to compile.

/// Lists every field of a type in its order. A field that is added to the type and not here does not compile.
#define SPRINGPROOF_FIELDS(Type, ...)                                                                        \
  template<class Archive>                                                                                    \
  void serialize(Archive& archive, Type& value) {                                                            \
    auto& [__VA_ARGS__] = value;                                                                             \
    archive(__VA_ARGS__);                                                                                    \
  }

namespace cereal { // where cereal looks for them, whatever the type's own namespace

template<class Archive>
void serialize(Archive& archive, Eigen::Vector3d& vector) {
  archive(binary_data(vector.data(), 3 * sizeof(double)));
}

SPRINGPROOF_FIELDS(springproof::cases::Selection, nodes, edges, faces)
SPRINGPROOF_FIELDS(springproof::cases::Grid, cells, spacing, origin, present)
SPRINGPROOF_FIELDS(springproof::cases::GridNodes, cells, origin, step, far_corner)
SPRINGPROOF_FIELDS(springproof::cases::GridCells, cells)
template<class Archive, class Rule>
void serialize(Archive& archive, springproof::cases::RuledList<Rule>& list) {
  archive(list.values, list.rule);
}
SPRINGPROOF_FIELDS(springproof::cases::TriangleMesh, vertices, triangles)
SPRINGPROOF_FIELDS(springproof::cases::HexMesh, nodes, cells, groups, group_of_cell, grid)

} // namespace cereal

namespace springproof::cases {

/// Values as bytes, which from_bytes() takes over to the last bit.
template<class Archive = cereal::PortableBinaryOutputArchive, class... Values>
std::string to_bytes(const Values&... values) {
  std::ostringstream stream;
  Archive archive(stream);
  archive(values...);
  return stream.str();
}

/// @param bytes  any
/// @throws std::exception if these are not the bytes of such values
template<class... Values>
void from_bytes(const std::string& bytes, Values&... values) {
  cereal::StrictInputArchive archive(bytes);
  archive(values...);
  if (archive.n_left() > 0) throw cereal::Exception("bytes are left over");
}

} // namespace springproof::cases
