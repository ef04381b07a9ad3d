#include "compare/gnuplot.hpp"

#include "cases/error.hpp"
#include "compare/atomic_file.hpp"

#include <cstdlib>
#include <fmt/format.h>
#include <fmt/ostream.h>

namespace compare {

namespace {

std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result + "'";
}

} // namespace

void draw(const std::string& folder, const std::string& name, const std::string& script, int width,
          int height) {
  write_file(folder + "/" + name + ".gp", [&](std::ostream& out) {
    fmt::print(
        out,
        "# gnuplot {0}.gp draws {0}.svg and {0}.png from the data beside it.\nset datafile separator ','\n",
        name);
    fmt::print(out, "set encoding utf8\n");
    for (const char* format : {"svg enhanced background 'white'", "pngcairo enhanced"}) {
      const std::string suffix = format[0] == 's' ? "svg" : "png";
      fmt::print(out,
                 "\nset terminal {} size {},{} font 'Sans,12'\nset output '{}.{}'\n{}\nunset output\nreset\n",
                 format, width, height, name, suffix, script);
      fmt::print(out, "set datafile separator ','\n");
    }
  });
  const std::string command = fmt::format("cd {} && gnuplot {} 2>{}", quoted(folder), quoted(name + ".gp"),
                                          quoted(name + ".gnuplot.log"));
  if (std::system(command.c_str()) != 0)
    throw cases::InputError(folder + "/" + name + ".gp: gnuplot could not draw it; see " + name +
                            ".gnuplot.log");
  std::remove((folder + "/" + name + ".gnuplot.log").c_str());
}

} // namespace compare
