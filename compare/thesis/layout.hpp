#pragma once

#include "compare/thesis/sheets.hpp"

/// The thesis's tables in lines of a screen.
namespace springproof::compare {

/// A table as it stands on the screen.
struct Layout {
  struct Row {
    std::string label;
    std::vector<const TableEntry*> cells; ///< one per head; null where print has no figure
  };
  std::string title;
  std::vector<std::string> heads;
  std::vector<Row> rows;
  std::size_t cell_width; ///< characters
};
Layout layout_of(const Sheet& sheet);

/// Our value and its difference from print: "  34.21   +0.05". The value is against the reference that the
/// case file declares; "*" says that print is nearer to another reference of the thesis. "failed" without a
/// value of the declared one; "!" when another reference's solve failed.
std::string cell_text(const TableEntry& entry);

/// A table's lines, without their ends; one that is wider than the screen is divided into parts of as many
/// columns as fit.
std::vector<std::string> lines_of(const Layout& layout);

/// All tables' lines, an empty one between them; two neighbours that are narrow stand side by side.
std::vector<std::string> lines_of(const std::vector<Sheet>& sheets);

} // namespace springproof::compare
