#pragma once

#include <map>
#include <string>
#include <variant>
#include <vector>

namespace springproof::compare {

/// What a script of plots/ is given, by the names that it uses: numbers, texts, and lists (not empty) of
/// them.
using PlotValues =
    std::map<std::string, std::variant<double, std::string, std::vector<double>, std::vector<std::string>>>;

/// Draws a figure twice, as NAME.svg and NAME.png, with gnuplot. The script stays beside them as NAME.gp: the
/// values, in which a text is a literal whatever it holds, then plots/style.gp and plots/SCRIPT.gp.
/// @param folder  where the files go; the script finds its data there by bare name, NAME.csv unless it says
/// else
/// @param values  `width` and `height` are those of the picture in pixels, 800 and 600 unless given
/// @throws InputError if the folder cannot be written, or with gnuplot's message if it fails
void draw(const std::string& folder, const std::string& name, const std::string& script,
          PlotValues values = {});

} // namespace springproof::compare
