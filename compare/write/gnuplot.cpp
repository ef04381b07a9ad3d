#include "compare/write/gnuplot.hpp"

#include "cases/case/error.hpp"
#include "cases/case/installation.hpp"
#include "compare/provenance/call_program.hpp"
#include "compare/provenance/print.hpp"
#include "compare/provenance/whole_file.hpp"

#include <cmath>
#include <cstring>
#include <fmt/ostream.h>

namespace springproof::compare {

namespace {

/// gnuplot interprets nothing between single quotes, and a line break would end it. A quote is a text of its
/// own by its number, joined to the others: gnuplot takes two at the beginning of a text for all of it, and
/// looks for macros behind one between double quotes.
std::string literal(const std::string& text) {
  std::string result = "'";
  for (const char c : one_line(text)) result += c == '\'' ? "'.\"\\047\".'" : std::string(1, c);
  return result + "'";
}

std::string literal(double number) {
  return std::isfinite(number) ? fmt::format("{}", number) : "NaN";
}

template<class Value>
std::string assignment(const std::string& name, const Value& value) {
  return fmt::format("{} = {}\n", name, literal(value));
}

template<class Value>
std::string assignment(const std::string& name, const std::vector<Value>& values) {
  std::vector<std::string> literals;
  for (const Value& value : values) literals.push_back(literal(value));
  return fmt::format("array {}[{}] = [{}]\n", name, values.size(), fmt::join(literals, ", "));
}

void write_script(std::ostream& out, const std::string& name, const std::string& script,
                  const PlotValues& values) {
  fmt::print(out, "# gnuplot {0}.gp draws {0}.svg and {0}.png from the data beside it.\n", name);
  for (const auto& [key, value] : values)
    out << std::visit([&name_of = key](const auto& known) { return assignment(name_of, known); }, value);
  const std::string plots = cases::data_folder("plots") + "/";
  for (const char* format : {"svg", "png"})
    fmt::print(out, "\nformat = '{}'\n{}\n{}", format, read_file(plots + "style.gp"),
               read_file(plots + script + ".gp"));
}

/// Runs gnuplot on FOLDER/NAME.gp, without the user's settings.
/// @param part  ending of the pictures' names
void run_gnuplot(const std::string& folder, const std::string& name, const std::string& part) {
  const std::string script = name + ".gp";
  const auto end =
      call_program({{"gnuplot", "-d", "-e", "part = " + literal(part), "./" + script}, folder, {}});
  if (!end) throw cases::InputError("gnuplot, which draws the figures, is not installed");
  if (end->status != 0)
    throw cases::InputError(fmt::format("{}/{}: gnuplot failed: {}", folder, script, end->said));
}

/// gnuplot does not notice a full disk.
/// @param picture  its name when it is whole
void check_end(const std::string& drawn, const std::string& picture, const std::string& end) {
  const std::string content = read_file(drawn);
  if (content.size() < end.size() || content.compare(content.size() - end.size(), end.size(), end) != 0)
    throw cases::InputError("cannot write '" + picture + "': gnuplot has drawn a part of it");
}

} // namespace

void draw(const std::string& folder, const std::string& name, const std::string& script, PlotValues values) {
  values.insert({{"name", name}, {"width", 800.0}, {"height", 600.0}});
  const std::string file = folder + "/" + name;
  write_file(file + ".gp", [&](std::ostream& out) { write_script(out, name, script, values); });
  make_file(file + ".svg", [&](const std::string& svg) {
    make_file(file + ".png", [&](const std::string& png) {
      run_gnuplot(folder, name, svg.substr(file.size() + std::strlen(".svg")));
      check_end(svg, file + ".svg", "</svg>\n\n");
      check_end(png, file + ".png", "IEND\xae\x42\x60\x82");
    });
  });
}

} // namespace springproof::compare
