#include "compare/thesis/figures.hpp"

#include "tests/support/temporary_folder.hpp"

#include <catch2/catch.hpp>
#include <fstream>
#include <sstream>

using namespace springproof;

using Points = std::vector<Eigen::Vector3d>;

namespace {

/// The blocks of a gnuplot data file: lines of numbers, parted by blank lines, in blocks parted by two.
std::vector<std::vector<std::string>> blocks_of(const std::filesystem::path& path) {
  std::vector<std::vector<std::string>> blocks(1);
  std::ifstream file(path);
  int n_blank = 0;
  for (std::string line; std::getline(file, line);) {
    if (line.empty()) {
      ++n_blank;
      continue;
    }
    if (n_blank >= 2) blocks.emplace_back();
    n_blank = 0;
    if (line[0] != '#') blocks.back().push_back(line);
  }
  return blocks;
}

} // namespace

TEST_CASE("a figure of bodies holds the faces and edges that look at the viewer, displaced") {
  const TemporaryFolder folder;
  const cases::HexMesh mesh = cases::make_box_mesh({1, 1, 1}, {{1, 1, 1}});
  const Points fem(8, {0, 0, 0.5}), springs(8, {2, 0, 0});
  compare::plot_bodies(folder.path.string(), "cube", {{"one", {&mesh, &fem}, {&mesh, &springs}}}, 1);
  const auto blocks = blocks_of(folder.path / "cube.csv");
  REQUIRE(blocks.size() == 3);
  CHECK(blocks[0].size() == 3 * 5); // of a cube three faces are seen: closed polygons
  CHECK(blocks[1].size() == 9 * 2); // and nine edges, each drawn once
  CHECK(blocks[2].size() == 9 * 2); // all of them sharp
  const auto has = [](const std::vector<std::string>& lines, const std::string& start) {
    for (const std::string& line : lines)
      if (line.rfind(start, 0) == 0) return true;
    return false;
  };
  CHECK(has(blocks[0], "1.0000,0.0000,1.5000,"));
  CHECK(has(blocks[1], "3.0000,0.0000,1.0000,"));
  CHECK(has(blocks[2], "1.0000,0.0000,1.0000,"));
  CHECK_FALSE(has(blocks[0], "0.0000,1.0000,0.5000,")); // the hidden corner
  for (const char* file : {"cube.svg", "cube.png", "cube.gp"})
    CHECK(std::filesystem::file_size(folder.path / file) > 100);
}

TEST_CASE("a body without an equilibrium leaves its place in the figure empty") {
  const TemporaryFolder folder;
  const cases::HexMesh mesh = cases::make_box_mesh({1, 1, 1}, {{1, 1, 1}});
  const Points fem(8, {0, 0, 0.5}), none;
  compare::plot_bodies(folder.path.string(), "cube", {{"one", {&mesh, &fem}, {&mesh, &none}}}, 1);
  const auto blocks = blocks_of(folder.path / "cube.csv");
  REQUIRE(blocks.size() == 3);
  CHECK(blocks[1] == std::vector<std::string>{"?,?,?,?,?"});
}
