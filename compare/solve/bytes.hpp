#pragma once

#include "cases/case/solution.hpp"

#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <type_traits>

/// Values as bytes for another process of this program on this machine. A type that is not trivially copyable
/// has a transfer() that visits its fields; it serves both directions.
namespace springproof::compare {

class Writer {
 public:
  void raw(const void* from, std::size_t size) { bytes.append(static_cast<const char*>(from), size); }
  template<class Container>
  void resize(Container& container) {
    std::uint64_t size = container.size();
    raw(&size, sizeof size);
  }
  template<class Value>
  void presence(std::optional<Value>& optional) {
    const char present = optional ? 1 : 0;
    raw(&present, 1);
  }
  std::string bytes;
};

class Reader {
 public:
  explicit Reader(const std::string& bytes) : bytes_(bytes) {}
  void raw(void* to, std::size_t size) {
    if (bytes_.size() - at_ < size) throw std::runtime_error("a stored answer ends too early");
    std::memcpy(to, bytes_.data() + at_, size);
    at_ += size;
  }
  template<class Container>
  void resize(Container& container) {
    std::uint64_t size = 0;
    raw(&size, sizeof size);
    if (size > bytes_.size()) throw std::runtime_error("a stored answer has a broken length");
    container.resize(size);
  }
  template<class Value>
  void presence(std::optional<Value>& optional) {
    char present = 0;
    raw(&present, 1);
    if (present)
      optional.emplace();
    else
      optional.reset();
  }
  bool at_end() const { return at_ == bytes_.size(); }

 private:
  const std::string& bytes_;
  std::size_t at_ = 0;
};

template<class Archive, class Value>
void transfer(Archive& archive, Value& value);

/// One after the other.
template<class Archive, class... Values>
void transfer_all(Archive& archive, Values&... values) {
  (transfer(archive, values), ...);
}

template<class Archive>
void transfer(Archive& archive, Eigen::Vector3d& vector) {
  archive.raw(vector.data(), 3 * sizeof(double));
}

template<class Archive>
void transfer(Archive& archive, std::string& text) {
  archive.resize(text);
  archive.raw(text.data(), text.size());
}

template<class Archive, class Value>
void transfer(Archive& archive, std::vector<Value>& values) {
  archive.resize(values);
  for (Value& value : values) transfer(archive, value);
}

template<class Archive, class Value>
void transfer(Archive& archive, std::optional<Value>& optional) {
  archive.presence(optional);
  if (optional) transfer(archive, *optional);
}

template<class Archive>
void transfer(Archive& archive, cases::Solution& s) {
  transfer_all(archive, s.status, s.message, s.outcome, s.displacement, s.cell_volume, s.unknowns, s.residual,
               s.load_reached, s.newton_iterations, s.relaxation_iterations, s.linear_iterations,
               s.force_evaluations, s.factorisations, s.lowest_eigenvalue, s.negative_eigenvalues,
               s.inverted_cells);
}

template<class Archive, class Value>
void transfer(Archive& archive, Value& value) {
  static_assert(std::is_trivially_copyable_v<Value>, "a field of this type needs its own transfer()");
  archive.raw(&value, sizeof value);
}

} // namespace springproof::compare
