#include "cases/mesh/read_mesh.hpp"

#include "cases/case/case.hpp"
#include "cases/mesh/fields.hpp"

#include <catch2/catch.hpp>

using namespace springproof;

using namespace cases;

namespace {

Mesh bar() {
  Mesh mesh = make_box_mesh({2, 1, 1}, {2, 1, 1});
  mesh.groups["end"] = {{0, 3, 6, 9}, {{0, 3}}, {{0, 6, 9, 3}}};
  mesh.group_of_cell = {"left", "right"};
  return mesh;
}

std::string bytes_with_length(std::uint64_t length) {
  std::string bytes = bytes_of_mesh(bar());
  std::memcpy(bytes.data() + 5, &length, sizeof length); // the nodes' length, after byte order and shape
  return bytes;
}

} // namespace

TEST_CASE("a mesh comes back from its bytes with its grid") {
  const Mesh before = bar(), after = mesh_from(bytes_of_mesh(before));
  CHECK(after.nodes.to_vector() == before.nodes.to_vector());
  CHECK(after.cells.to_vector() == before.cells.to_vector());
  CHECK(after.groups.at("end").faces == before.groups.at("end").faces);
  CHECK(after.group_of_cell == before.group_of_cell);
  REQUIRE(after.grid);
  CHECK(after.grid->cells == before.grid->cells);
}

TEST_CASE("bytes that are no mesh are refused: cut, too long, an impossible length") {
  const std::string whole = bytes_of_mesh(bar());
  for (std::size_t size = 0; size < whole.size(); ++size) {
    CAPTURE(size);
    REQUIRE_THROWS_AS(mesh_from(whole.substr(0, size)), std::runtime_error);
  }
  CHECK_THROWS_AS(mesh_from(whole + "x"), std::runtime_error);
  for (const std::uint64_t length : {std::uint64_t{1} << 30, std::uint64_t{1} << 62, ~std::uint64_t{0}})
    CHECK_THROWS_WITH(mesh_from(bytes_with_length(length)), Catch::Contains("more than the bytes hold"));
}

TEST_CASE("bytes with any one bit flipped are refused, or hold a mesh whose nodes exist") {
  const std::string whole = bytes_of_mesh(bar());
  for (std::size_t at = 0; at < whole.size(); ++at)
    for (int bit = 0; bit < 8; ++bit) {
      std::string damaged = whole;
      damaged[at] = static_cast<char>(damaged[at] ^ (1 << bit));
      try {
        const Mesh mesh = mesh_from(damaged);
        CAPTURE(at, bit);
        for (const auto& cell : mesh.cells)
          for (const int node : cell) REQUIRE(index(node) < mesh.nodes.size());
        for (const auto& node : mesh.nodes) REQUIRE(node.allFinite());
        for (const auto& [name, group] : mesh.groups)
          for (const int node : group.nodes) REQUIRE(index(node) < mesh.nodes.size());
      } catch (const std::runtime_error&) {
        // refused
      }
    }
}

TEST_CASE("enumerators without a name and truth values that are none are refused") {
  bool truth = false;
  CHECK_THROWS_WITH(from_bytes("\1\2", truth), Catch::Contains("neither 0 nor 1"));
  Statistic kind{};
  CHECK_NOTHROW(from_bytes(std::string("\1\0\0\0\0", 5), kind));
  CHECK_THROWS_WITH(from_bytes(std::string("\1\77\0\0\0", 5), kind), Catch::Contains("no name"));
  CHECK_THROWS_WITH(from_bytes(std::string("\1\377\377\377\377", 5), kind), Catch::Contains("no name"));
}
