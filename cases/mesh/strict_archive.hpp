#pragma once

#include "cases/case/names.hpp"

#include <cereal/archives/portable_binary.hpp>
#include <cereal/types/common.hpp>
#include <cstring>
#include <string_view>

namespace cereal {

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

namespace traits::detail { // which archive writes what this one reads
template<>
struct get_output_from_input<StrictInputArchive> {
  using type = PortableBinaryOutputArchive;
};
} // namespace traits::detail

} // namespace cereal
