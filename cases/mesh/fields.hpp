#pragma once

#include "cases/case/names.hpp"
#include "cases/mesh/mesh.hpp"
#include "cases/mesh/triangle_mesh.hpp"

#include <cereal/archives/portable_binary.hpp>
#include <cereal/types/array.hpp>
#include <cereal/types/common.hpp>
#include <cereal/types/map.hpp>
#include <cereal/types/optional.hpp>
#include <cereal/types/string.hpp>
#include <cereal/types/vector.hpp>
#include <cstring>
#include <sstream>
#include <string_view>

/// Values as bytes, to be kept in files or sent to other processes, by cereal. Portable binary and not JSON:
/// displacements keep their last bit, in a third of the bytes. To be included by the few sources that keep or
/// send: cereal is slow to compile.

namespace cereal { // where cereal looks for them, whatever the type's own namespace

/// Reads what a PortableBinaryOutputArchive has written, from bytes that anybody may have made: a length is
/// refused that the remaining bytes cannot hold, a truth value is 0 or 1, an enumerator has a name. cereal's
/// own archive allocates whatever length it reads, and casts any number to an enumeration.
class StrictInputArchive : public InputArchive<StrictInputArchive, AllowEmptyClassElision> {
 public:
  /// @param bytes  must outlive the archive  @throws Exception if they are of another byte order
  explicit StrictInputArchive(std::string_view bytes)
      : InputArchive<StrictInputArchive, AllowEmptyClassElision>(this), bytes_(bytes) {
    std::uint8_t is_little_endian = 0;
    (*this)(is_little_endian);
    if (is_little_endian != portable_binary_detail::is_little_endian())
      throw Exception("the bytes are of another machine");
  }

  void take(void* to, std::size_t size) {
    if (size > bytes_.size()) throw Exception("the bytes end too early");
    if (size > 0) std::memcpy(to, bytes_.data(), size);
    bytes_.remove_prefix(size);
  }
  std::size_t n_left() const { return bytes_.size(); }

 private:
  std::string_view bytes_;
};

template<class T>
std::enable_if_t<std::is_arithmetic_v<T>> load(StrictInputArchive& archive, T& number) {
  if constexpr (std::is_same_v<T, bool>) {
    std::uint8_t truth = 0;
    archive.take(&truth, 1);
    if (truth > 1) throw Exception("a truth value is neither 0 nor 1");
    number = truth == 1;
  } else {
    archive.take(&number, sizeof number);
  }
}

template<class T>
void load(StrictInputArchive& archive, BinaryData<T>& numbers) {
  archive.take(numbers.data, static_cast<std::size_t>(numbers.size));
}

template<class T>
void load(StrictInputArchive& archive, NameValuePair<T>& named) {
  archive(named.value);
}

/// An element takes at least a byte.
template<class T>
void load(StrictInputArchive& archive, SizeTag<T>& length) {
  archive(length.size);
  if (length.size > archive.n_left()) throw Exception("a length is more than the bytes hold");
}

template<class T>
std::enable_if_t<common_detail::is_enum<T>::value>
load_minimal(const StrictInputArchive&, T&& value,
             const typename common_detail::is_enum<T>::base_type& read) {
  using Enum = typename common_detail::is_enum<T>::type;
  if (read < 0 || static_cast<std::size_t>(read) >= springproof::cases::all_names<Enum>().size())
    throw Exception("an enumerator has no name");
  value = static_cast<Enum>(read);
}

namespace traits::detail { // names the archive that writes what this one reads
template<>
struct get_output_from_input<StrictInputArchive> {
  using type = PortableBinaryOutputArchive;
};
} // namespace traits::detail

template<class Archive>
void serialize(Archive& archive, Eigen::Vector3d& vector) {
  archive(binary_data(vector.data(), 3 * sizeof(double)));
}

/// A list without memory of its own, as one with.
template<class Archive, class Value, std::size_t most>
void save(Archive& archive, const boost::container::static_vector<Value, most>& list) {
  archive(std::vector<Value>(list.begin(), list.end()));
}
template<class Archive, class Value, std::size_t most>
void load(Archive& archive, boost::container::static_vector<Value, most>& list) {
  std::vector<Value> values;
  archive(values);
  if (values.size() > most) throw Exception("a list is longer than its kind");
  list.assign(values.begin(), values.end());
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
SPRINGPROOF_FIELDS(springproof::cases::Mesh, shape, nodes, cells, groups, group_of_cell, grid, lines)

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
