#pragma once

#include "msm/grid/body.hpp"

namespace springproof::msm::grid {

/// Vectors that have the entries of a body's nodes alone: all x, then all y, then all z. A field has places
/// for the whole of the body's box and ghosts too, several times as many where a body fills little of it.
/// Where there is little to gain, and on a part of a body, a vector is a field.
class NodeVectors {
 public:
  /// Returns an object whose vectors are the body's fields.
  static NodeVectors fields(const Body& body) { return NodeVectors(body, true); }
  explicit NodeVectors(const Body& body) : NodeVectors(body, false) {}

  bool are_fields() const { return runs_.empty(); }
  Eigen::Index size() const { return 3 * n_; } ///< entries of a vector

  /// Returns a vector as a field.
  /// @param room  holds the result unless the vector is a field; ghosts and places without a cell are 0
  const Field<double>& to_field(const Field<double>& vector, Field<double>& room) const;
  /// Calls write(field) and takes what it wrote as a vector.
  /// @param room  as for to_field(), but no field that write() reads
  template<class Write>
  void from_field(const Write& write, Field<double>& room, Field<double>& vector) const {
    if (are_fields()) {
      write(vector);
      return;
    }
    if (room.size() != size_of_field_) room.setZero(size_of_field_);
    write(room);
    gather(room, vector);
  }
  Field<double> from_field(const Field<double>& field) const;
  /// field = factor * vector, in single precision; places without a cell stay as they are, or 0.
  void to_field(const Field<double>& vector, double factor, Field<float>& field) const;
  /// vector = factor * field
  void from_field(const Field<float>& field, double factor, Field<double>& vector) const;
  /// Returns the entry of a vector for a field's entry; -1: it has none.
  Eigen::Index entry(std::ptrdiff_t of_field) const;
  /// Returns the entry of a field for a vector's entry.
  std::ptrdiff_t in_field(Eigen::Index of_vector) const;

 private:
  /// Nodes that follow each other in a row.
  struct Run {
    std::ptrdiff_t in_field, in_vector, length;
  };
  std::vector<Run> runs_; ///< none: vectors are fields
  std::ptrdiff_t size_of_array_, size_of_field_, n_;

  NodeVectors(const Body& body, bool are_fields);
  /// Calls action(place in a field, place in a vector, length) for every stretch that is contiguous in both.
  template<class Action>
  void for_each_run(const Action& action) const {
    for (int c = 0; c < 3; ++c)
      for (const Run& run : runs_)
        action(c * size_of_array_ + run.in_field, c * n_ + run.in_vector, run.length);
    if (are_fields()) action(std::ptrdiff_t{0}, std::ptrdiff_t{0}, size_of_field_);
  }
  void gather(const Field<double>& field, Field<double>& vector) const;
};

} // namespace springproof::msm::grid
