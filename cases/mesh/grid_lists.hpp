#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

namespace springproof::cases {

/// Places of the nodes of a grid whose cells are all present, x fastest.
struct GridNodes {
  using Value = Eigen::Vector3d;
  std::array<int, 3> cells{}; ///< along x, y, z; 0: no nodes
  Eigen::Vector3d origin = Eigen::Vector3d::Zero(), step = Eigen::Vector3d::Zero(); ///< mm
  Eigen::Vector3d far_corner = Eigen::Vector3d::Zero(); ///< mm, where the last nodes lie: n * step is rounded

  std::size_t size() const {
    std::size_t n = 1;
    for (const int along : cells) n *= along == 0 ? 0 : static_cast<std::size_t>(along) + 1;
    return n;
  }
  Eigen::Vector3d operator[](std::size_t node) const {
    Eigen::Vector3d at;
    for (std::size_t a = 0; a < 3; ++a) {
      const auto n_cells = static_cast<std::size_t>(cells[a]), n = a == 2 ? node : node % (n_cells + 1);
      const auto axis = static_cast<Eigen::Index>(a);
      at[axis] = n == n_cells ? far_corner[axis] : origin[axis] + static_cast<double>(n) * step[axis];
      node /= n_cells + 1;
    }
    return at;
  }
};

/// Vertices of its cells.
struct GridCells {
  using Value = std::array<int, 8>;
  std::array<int, 3> cells{}; ///< along x, y, z; 0: none

  std::size_t size() const {
    std::size_t n = 1;
    for (const int along : cells) n *= static_cast<std::size_t>(along);
    return n;
  }
  std::array<int, 8> operator[](std::size_t cell) const {
    const auto in_row = static_cast<std::size_t>(cells[0]), rows = static_cast<std::size_t>(cells[1]);
    const int row = cells[0] + 1, layer = row * (cells[1] + 1);
    const int first = static_cast<int>(cell % in_row) + row * static_cast<int>(cell / in_row % rows) +
                      layer * static_cast<int>(cell / in_row / rows);
    std::array<int, 8> vertices{};
    for (int v = 0; v < 8; ++v)
      vertices[static_cast<std::size_t>(v)] = first + (v & 1) + ((v >> 1) & 1) * row + (v >> 2) * layer;
    return vertices;
  }
};

/// A list of values that are stored or, where a rule gives them, need no memory. Elements are values, not
/// references: an Eigen expression of one must not outlive its statement; they are constant, so that what
/// would change a copy does not compile.
template<class Rule>
class RuledList {
 public:
  using value_type = typename Rule::Value;

  std::vector<value_type> values; ///< none where there is a rule
  std::optional<Rule> rule;

  RuledList() = default;
  RuledList(std::vector<value_type> the_values) : values(std::move(the_values)) {}
  explicit RuledList(const Rule& the_rule) : rule(the_rule) {}

  std::size_t size() const { return rule ? rule->size() : values.size(); }
  bool empty() const { return size() == 0; }
  const value_type operator[](std::size_t i) const { return rule ? (*rule)[i] : values[i]; }
  const value_type front() const { return (*this)[0]; }
  const value_type back() const { return (*this)[size() - 1]; }

  class Iterator {
   public:
    using iterator_category = std::forward_iterator_tag;
    using value_type = typename Rule::Value;
    using difference_type = std::ptrdiff_t;
    using pointer = void;
    using reference = value_type;

    Iterator(const RuledList& list, std::size_t i) : list_(&list), i_(i) {}
    value_type operator*() const { return (*list_)[i_]; }
    Iterator& operator++() {
      ++i_;
      return *this;
    }
    bool operator==(const Iterator& other) const { return i_ == other.i_; }
    bool operator!=(const Iterator& other) const { return i_ != other.i_; }
    std::size_t number() const { return i_; } ///< in the list

   private:
    const RuledList* list_;
    std::size_t i_;
  };
  Iterator begin() const { return {*this, 0}; }
  Iterator end() const { return {*this, size()}; }

  /// The values for changes; from now on they are stored.
  std::vector<value_type>& stored() {
    if (rule) values = to_vector();
    rule.reset();
    return values;
  }
  std::vector<value_type> to_vector() const {
    std::vector<value_type> all;
    all.reserve(size());
    for (const value_type& value : *this) all.push_back(value);
    return all;
  }
};

} // namespace springproof::cases
