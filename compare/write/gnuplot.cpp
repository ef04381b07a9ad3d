#include "compare/write/gnuplot.hpp"

#include "cases/case/error.hpp"
#include "compare/write/whole_file.hpp"

#include <cstdlib>
#include <fmt/format.h>
#include <fmt/ostream.h>

namespace springproof::compare {

namespace {

std::string shell_quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result + "'";
}

/// Colours of Okabe and Ito (2008), which the colour-blind tell apart, each with its own dashes and marker,
/// so that a figure survives a black-and-white printer. The finite elements are linetype 1 and the springs
/// linetype 2 everywhere.
constexpr const char* style = R"(set linetype 1 lc rgb '#0072B2' lw 2 dt solid pt 7
set linetype 2 lc rgb '#D55E00' lw 2 dt (12,5) pt 5
set linetype 3 lc rgb '#009E73' lw 2 dt (3,4) pt 9
set linetype 4 lc rgb '#CC79A7' lw 2 dt (12,4,3,4) pt 13
set linetype 5 lc rgb '#E69F00' lw 2 dt (20,5) pt 11
set linetype 6 lc rgb '#56B4E9' lw 2 dt (6,6) pt 4
set linetype 7 lc rgb '#000000' lw 2 dt (3,8) pt 6
set linetype 8 lc rgb '#777777' lw 2 dt (20,4,3,4,3,4) pt 8
set linetype cycle 8
set border 3 lc rgb '#333333'
set tics nomirror
set grid lc rgb '#dddddd' lt 1 lw 0.5 dt solid
set key Left reverse samplen 4 spacing 1.2
)";

} // namespace

void draw(const std::string& folder, const std::string& name, const std::string& script, int width,
          int height) {
  write_file(folder + "/" + name + ".gp", [&](std::ostream& out) {
    fmt::print(out, "# gnuplot {0}.gp draws {0}.svg and {0}.png from the data beside it.\n", name);
    for (const char* format : {"svg enhanced background 'white'", "pngcairo enhanced"}) {
      const std::string suffix = format[0] == 's' ? "svg" : "png";
      fmt::print(out,
                 "\nreset\nset encoding utf8\nset datafile separator ','\nset terminal {} size {},{} font "
                 "'Sans,12'\n{}set output '{}.{}'\n{}\nunset output\n",
                 format, width, height, style, name, suffix, script);
    }
  });
  const std::string command = fmt::format("cd {} && gnuplot {} 2>{}", shell_quoted(folder),
                                          shell_quoted(name + ".gp"), shell_quoted(name + ".gnuplot.log"));
  if (std::system(command.c_str()) != 0)
    throw cases::InputError(folder + "/" + name + ".gp: gnuplot could not draw it; see " + name +
                            ".gnuplot.log");
  std::remove((folder + "/" + name + ".gnuplot.log").c_str());
}

} // namespace springproof::compare
