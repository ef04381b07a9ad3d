#pragma once

#include <string>

namespace springproof::compare {

/// Draws a figure twice, as NAME.svg and NAME.png, with gnuplot; the script stays beside them as NAME.gp.
/// Every figure shares one style: linetypes 1 to 8 differ in colour, dashes and marker; 1 is the finite
/// elements' (or the reference's), 2 the springs'.
/// @param folder  where the files go; the script finds its data there by bare name
/// @param script  gnuplot commands, without terminal and output
/// @param width, height  of the picture, pixels
/// @throws InputError if the folder cannot be written or gnuplot fails
void draw(const std::string& folder, const std::string& name, const std::string& script, int width = 800,
          int height = 600);

} // namespace springproof::compare
