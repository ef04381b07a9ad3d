#include "msm/grid/node_vectors.hpp"

#include <catch2/catch.hpp>

using namespace springproof;

using msm::grid::Body;
using msm::grid::Field;
using msm::grid::NodeVectors;

namespace node_vectors {

namespace {

Body body_of(const std::array<int, 3>& cells, const std::function<bool(int i, int j, int k)>& has_cell) {
  Body body;
  body.cells = cells;
  body.spacing = {1, 1, 1};
  msm::grid::for_each_place(cells, [&](int i, int j, int k) {
    body.springs.emplace_back();
    if (has_cell(i, j, k)) body.springs.back() = {{1, 1, 1}, {1, 1, 1}, 1, 1};
  });
  set_layout(body, [](int, int, int, int) { return false; });
  return body;
}

} // namespace

TEST_CASE("vectors of a body's nodes and its fields say the same") {
  // Two legs, 2 x 3 cells each and 8 high, on a foot: a row of nodes has gaps.
  const Body body =
      body_of({9, 4, 9}, [](int i, int j, int k) { return j < 3 && (k == 0 || i < 2 || i > 6); });
  const NodeVectors vectors(body);
  REQUIRE_FALSE(vectors.are_fields());
  int n_nodes = 0;
  msm::grid::for_each_place(body.layout.nodes,
                            [&](int i, int j, int k) { n_nodes += msm::grid::has_cell(body, i, j, k); });
  CHECK(vectors.size() == 3 * n_nodes);

  Field<double> field = Field<double>::Zero(3 * body.layout.size);
  std::vector<int> times_found(static_cast<std::size_t>(vectors.size()));
  const Field<double> vector = [&] {
    for (Eigen::Index e = 0; e < field.size(); ++e)
      if (vectors.entry(e) >= 0) field[e] = static_cast<double>(e);
    return vectors.from_field(field);
  }();
  for (Eigen::Index e = 0; e < field.size(); ++e) {
    const Eigen::Index entry = vectors.entry(e);
    const auto [i, j, k, c] = body.layout.place(e);
    const bool is_node = body.layout.at(i, j, k, c) == e && i >= 0 && i < body.layout.nodes[0] && j >= 0 &&
                         j < body.layout.nodes[1] && k >= 0 && k < body.layout.nodes[2];
    CHECK((entry >= 0) == (is_node && msm::grid::has_cell(body, i, j, k)));
    if (entry < 0) continue;
    ++times_found[static_cast<std::size_t>(entry)];
    CHECK(vector[entry] == static_cast<double>(e));
    CHECK(vectors.in_field(entry) == e);
  }
  CHECK(std::count(times_found.begin(), times_found.end(), 1) == vectors.size());

  Field<double> room, other_room, written;
  CHECK(vectors.to_field(vector, room) == field);
  vectors.from_field([&](Field<double>& to) { to = 2 * field; }, other_room, written);
  CHECK(written == 2 * vector);
}

TEST_CASE("where a body fills its box, or on request, its vectors are fields") {
  const Body full = body_of({30, 30, 30}, [](int, int, int) { return true; }),
             hollow = body_of({9, 9, 9}, [](int i, int, int) { return i == 0; });
  for (const NodeVectors& vectors : {NodeVectors(full), NodeVectors::fields(hollow)}) {
    REQUIRE(vectors.are_fields());
    const Field<double> field = Field<double>::Random(vectors.size());
    Field<double> room;
    CHECK(&vectors.to_field(field, room) == &field);
    CHECK(vectors.entry(17) == 17);
  }
  CHECK_FALSE(NodeVectors(hollow).are_fields());
}

} // namespace node_vectors
