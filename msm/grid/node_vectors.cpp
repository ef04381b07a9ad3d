#include "msm/grid/node_vectors.hpp"

namespace springproof::msm::grid {

NodeVectors::NodeVectors(const Body& body, bool are_fields)
    : size_of_array_(body.layout.size), size_of_field_(3 * body.layout.size), n_(body.layout.size) {
  if (are_fields || body.part) return;
  std::vector<Run> runs;
  std::ptrdiff_t n = 0;
  for_each_place(body.layout.nodes, [&](int i, int j, int k) {
    if (!has_cell(body, i, j, k)) return;
    const std::ptrdiff_t at = body.layout.at(i, j, k);
    if (runs.empty() || runs.back().in_field + runs.back().length != at) runs.push_back({at, n, 0});
    ++runs.back().length;
    ++n;
  });
  constexpr double worth_it = 0.7; // of the places: below, copies take less time than what they spare
  if (static_cast<double>(n) > worth_it * static_cast<double>(n_)) return;
  runs_ = std::move(runs);
  n_ = n;
}

const Field<double>& NodeVectors::to_field(const Field<double>& vector, Field<double>& room) const {
  if (are_fields()) return vector;
  if (room.size() != size_of_field_) room.setZero(size_of_field_);
  for (int c = 0; c < 3; ++c) {
    const double* const from = vector.data() + c * n_;
    double* const to = room.data() + c * size_of_array_;
    for (const Run& run : runs_)
      for (std::ptrdiff_t i = 0; i < run.length; ++i) to[run.in_field + i] = from[run.in_vector + i];
  }
  return room;
}

void NodeVectors::gather(const Field<double>& field, Field<double>& vector) const {
  vector.resize(size());
  for (int c = 0; c < 3; ++c) {
    const double* const from = field.data() + c * size_of_array_;
    double* const to = vector.data() + c * n_;
    for (const Run& run : runs_)
      for (std::ptrdiff_t i = 0; i < run.length; ++i) to[run.in_vector + i] = from[run.in_field + i];
  }
}

Field<double> NodeVectors::from_field(const Field<double>& field) const {
  if (are_fields()) return field;
  Field<double> vector;
  gather(field, vector);
  return vector;
}

Eigen::Index NodeVectors::entry(std::ptrdiff_t of_field) const {
  if (are_fields()) return of_field;
  const std::ptrdiff_t c = of_field / size_of_array_, at = of_field % size_of_array_;
  auto run = std::upper_bound(runs_.begin(), runs_.end(), at,
                              [](std::ptrdiff_t place, const Run& of) { return place < of.in_field; });
  if (run == runs_.begin() || at >= std::prev(run)->in_field + std::prev(run)->length) return -1;
  --run;
  return c * n_ + run->in_vector + (at - run->in_field);
}

} // namespace springproof::msm::grid
