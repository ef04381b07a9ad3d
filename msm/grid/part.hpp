#pragma once

#include <array>
#include <cstddef>
#include <memory>

namespace springproof::msm::grid {

struct Body;

/// The other ranks, as a part of a grid sees them. Every function is collective.
class Ranks {
 public:
  virtual ~Ranks() = default;
  /// Ghost nodes of a field (three arrays of the part's layout) get their owners' values.
  virtual void update_ghosts(double* field) const = 0;
  virtual void update_ghosts(float* field) const = 0;
  /// Sums over the ranks, in place: the same ones on every rank.
  virtual void sum(double* values, std::size_t n) const = 0;
  virtual void sum(float* values, std::size_t n) const = 0;
  virtual double largest(double value) const = 0;
};

/// What one of several ranks has of a grid: a box of nodes that it owns, and around it, where the grid goes
/// on, one layer of nodes that others own (ghosts), with the cells between. So every spring and every cell at
/// an own node is here. Fields of all operators have their owners' values on ghosts, so that sums of fields
/// need no messages; what adds up over nodes or springs counts own ones alone.
struct Part {
  std::array<int, 3> first;               ///< node of the whole grid that is the part's node 0
  std::array<int, 3> own_first, own_last; ///< own nodes are first to last - 1, in the part's numbers
  std::array<int, 3> whole_nodes;         ///< of the whole grid
  std::shared_ptr<const Ranks> ranks;
  /// The next coarser body: a part again, or the whole of it, which every rank then has.
  std::shared_ptr<const Body> coarser;
  /// Where that is the whole of it: its nodes at and around this part, own ones as for parts.
  std::shared_ptr<const Body> coarser_here;

  bool owns(int i, int j, int k) const {
    return i >= own_first[0] && i < own_last[0] && j >= own_first[1] && j < own_last[1] &&
           k >= own_first[2] && k < own_last[2];
  }
};

/// The part of a whole body with own nodes first to last - 1 along each axis; ranks and coarser bodies are
/// not filled in.
Body cut_out(const Body& whole, const std::array<int, 3>& first, const std::array<int, 3>& last);

} // namespace springproof::msm::grid
