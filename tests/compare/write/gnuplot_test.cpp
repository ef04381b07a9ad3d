#include "compare/write/gnuplot.hpp"

#include "cases/case/error.hpp"
#include "compare/provenance/whole_file.hpp"
#include "tests/support/temporary_folder.hpp"

#include <catch2/catch.hpp>

using namespace springproof;

using Catch::Contains;
namespace fs = std::filesystem;

namespace {

/// A sweep's plot of one method, with any headline.
void draw_sweep(const TemporaryFolder& folder, const std::string& headline) {
  folder.write("plot.csv", "1,1\n2,2\n\n\n1,1\n\n\n1,1\n");
  compare::draw(folder.path.string(), "plot", "sweep",
                {{"headline", headline},
                 {"points", "plot.csv"},
                 {"time_label", "time, s"},
                 {"real_time", 0.},
                 {"methods", std::vector<std::string>{"one"}},
                 {"linetypes", std::vector{1.}},
                 {"markers", std::vector{0.}},
                 {"floors", std::vector{0.}},
                 {"uncertainty", 0.},
                 {"bottom", 0.1}});
}

} // namespace

TEST_CASE("a text in a plot is drawn as it stands, whatever gnuplot would make of it") {
  const TemporaryFolder folder;
  const std::string headline =
      GENERATE("Young's cube \\ {x_1} @y #z", "\"`touch P`\" $DATA << E", "x'; system 'touch P'; set title '",
               "x\nsystem 'touch P'\n", "'; system 'touch P'; x = '", "''; system 'touch P'", "'''");
  draw_sweep(folder, headline);
  CHECK_FALSE(fs::exists(folder.path / "P"));
  const std::string svg = compare::read_file((folder.path / "plot.svg").string());
  if (headline.front() == 'Y') CHECK_THAT(svg, Contains("Young's cube \\ {x_1} @y #z"));
}

TEST_CASE("a drawn figure leaves its pictures, its script, and nothing else") {
  const TemporaryFolder folder;
  draw_sweep(folder, "case");
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder.path)) names.push_back(entry.path().filename());
  std::sort(names.begin(), names.end());
  CHECK(names == std::vector<std::string>{"plot.csv", "plot.gp", "plot.png", "plot.svg"});
}

TEST_CASE("gnuplot's message is the error, and no picture is left") {
  const TemporaryFolder folder;
  CHECK_THROWS_WITH(compare::draw(folder.path.string(), "plot", "uniaxial"),
                    Contains("plot.gp") && Contains("gnuplot failed") && Contains("plot.csv"));
  CHECK_FALSE(fs::exists(folder.path / "plot.svg"));
}
