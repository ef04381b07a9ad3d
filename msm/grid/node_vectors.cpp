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
  constexpr double worth_it = 0.7; // share of the places: below it, copies take less time than they spare
  if (static_cast<double>(n) > worth_it * static_cast<double>(n_)) return;
  runs_ = std::move(runs);
  n_ = n;
}

const Field<double>& NodeVectors::to_field(const Field<double>& vector, Field<double>& room) const {
  if (are_fields()) return vector;
  if (room.size() != size_of_field_) room.setZero(size_of_field_);
  for_each_run([&](std::ptrdiff_t in_field, std::ptrdiff_t in_vector, std::ptrdiff_t n) {
    for (std::ptrdiff_t i = 0; i < n; ++i) room[in_field + i] = vector[in_vector + i];
  });
  return room;
}

void NodeVectors::to_field(const Field<double>& vector, double factor, Field<float>& field) const {
  if (field.size() != size_of_field_) field.setZero(size_of_field_);
  for_each_run([&](std::ptrdiff_t in_field, std::ptrdiff_t in_vector, std::ptrdiff_t n) {
    field.segment(in_field, n) = (factor * vector.segment(in_vector, n)).cast<float>();
  });
}

void NodeVectors::from_field(const Field<float>& field, double factor, Field<double>& vector) const {
  vector.resize(size());
  for_each_run([&](std::ptrdiff_t in_field, std::ptrdiff_t in_vector, std::ptrdiff_t n) {
    vector.segment(in_vector, n) = factor * field.segment(in_field, n).cast<double>();
  });
}

void NodeVectors::gather(const Field<double>& field, Field<double>& vector) const {
  vector.resize(size());
  for_each_run([&](std::ptrdiff_t in_field, std::ptrdiff_t in_vector, std::ptrdiff_t n) {
    for (std::ptrdiff_t i = 0; i < n; ++i) vector[in_vector + i] = field[in_field + i];
  });
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

std::ptrdiff_t NodeVectors::in_field(Eigen::Index of_vector) const {
  if (are_fields()) return of_vector;
  const std::ptrdiff_t c = of_vector / n_, at = of_vector % n_;
  const auto run =
      std::prev(std::upper_bound(runs_.begin(), runs_.end(), at,
                                 [](std::ptrdiff_t place, const Run& of) { return place < of.in_vector; }));
  return c * size_of_array_ + run->in_field + (at - run->in_vector);
}

} // namespace springproof::msm::grid
