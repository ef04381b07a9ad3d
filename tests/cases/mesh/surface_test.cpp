#include "cases/mesh/voxels.hpp"

#include "tests/support/case_text.hpp"

#include <catch2/catch.hpp>
#include <cstdint>
#include <cstring>

using namespace springproof;

using namespace cases;
using Eigen::Vector3d;

namespace {

const std::string tetrahedron = R"(solid one
facet normal 0 0 -1
  outer loop
    vertex 0 0 0
    vertex 0 1 0
    vertex 1 0 0
  endloop
endfacet
facet normal 0 -1 0
outer loop
vertex 0 0 0
vertex 1 0 0
vertex 0 0 1
endloop
endfacet
facet normal -1 0 0
outer loop
vertex 0 0 0
vertex -0.0 0 1e0
vertex 0 1 0
endloop
endfacet
facet normal 1 1 1
outer loop
vertex 1 0 0
vertex 0 1 0
vertex 0 0 1
endloop
endfacet
endsolid one
)";

std::string as_binary(const Surface& surface) {
  std::string bytes(80, ' ');
  bytes.replace(0, 5, "solid"); // some programs do
  const auto append = [&](const auto& value) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    bytes.append(raw, sizeof value);
  };
  append(static_cast<std::uint32_t>(surface.size()));
  for (const auto& triangle : surface) {
    for (int i = 0; i < 3; ++i) append(0.f);
    for (const Vector3d& vertex : triangle)
      for (int a = 0; a < 3; ++a) append(static_cast<float>(vertex[a]));
    append(static_cast<std::uint16_t>(0));
  }
  return bytes;
}

} // namespace

TEST_CASE("a surface is the same from text and from a binary file") {
  const TemporaryFolder folder;
  const Surface text = read_body_surface({folder.write("text.stl", tetrahedron)});
  REQUIRE(text.size() == 4);
  CHECK(text[1][2] == Vector3d(0, 0, 1));
  CHECK(read_body_surface({folder.write("binary.stl", as_binary(text))}) == text);
  CHECK(n_open_edges(joined(text)) == 0);
}

TEST_CASE("a surface with a facet missing, turned or doubled is not closed") {
  const TemporaryFolder folder;
  const Surface closed = read_body_surface({folder.write("a.stl", tetrahedron)});
  Surface open = closed, turned = closed, doubled = closed;
  open.pop_back();
  std::swap(turned[2][0], turned[2][1]);
  doubled.push_back(doubled[0]);
  CHECK(n_open_edges(joined(open)) == 3);
  CHECK(n_open_edges(joined(turned)) == 6); // each of its edges now runs twice the same way
  CHECK(n_open_edges(joined(doubled)) == 3);
}

TEST_CASE("what is no STL, is cut short or has a position that is not finite is refused with its name") {
  const TemporaryFolder folder;
  const std::string binary = as_binary(read_body_surface({folder.write("good.stl", tetrahedron)}));
  const std::vector<std::pair<std::string, std::string>> broken{
      {"", "Premature EOF"},
      {"solid nothing\nendsolid\n", "has no triangles"},
      {"$MeshFormat\n", "at line 1: Parse error. Expecting 'solid' found '$meshformat'"},
      {std::string(100, 'x'), "Expecting 'solid'"},
      {binary.substr(5, 50) + std::string(60, 'b'), "Expecting 'solid'"},
      {binary.substr(0, binary.size() - 1), "ends within a triangle"},
      {binary.substr(0, 80) + "\xff\xff\xff\xff" + binary.substr(84), "says that it has 4294967295"},
      {binary.substr(0, binary.size() - 50), "has 3 triangles, and says that it has 4"},
      {case_text::replaced(tetrahedron, "vertex 0 1 0", "vertex 0 one 0"), "at line 5: Parse error"},
      {case_text::replaced(tetrahedron, "vertex 0 1 0", "vertex 0 1"), "at line 5: Parse error"},
      {case_text::replaced(tetrahedron, "    vertex 0 1 0\n", ""), "Expecting 'vertex' found 'endloop'"},
      {tetrahedron.substr(0, tetrahedron.find("endloop")), "Premature EOF while reading 'endloop'"},
      {case_text::replaced(tetrahedron, "vertex 0 1 0", "vertex 0 inf 0"), "not finite"}};
  for (const auto& [text, says] : broken) {
    CAPTURE(says);
    const std::string path = folder.write("bad.stl", text);
    CHECK_THROWS_WITH(read_body_surface({path}), Catch::Contains("bad.stl") && Catch::Contains(says));
  }
  CHECK_THROWS_AS(read_body_surface({(folder.path / "none.stl").string()}), InputError);
}
