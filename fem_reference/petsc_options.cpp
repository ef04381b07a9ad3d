#include "fem_reference/session.hpp"

#include <regex>
#include <sstream>

namespace springproof::fem_reference {

std::string refused_petsc_option(const std::string& options) {
  static const std::regex is_solvers("-(msm_)?(snes|ksp|pc|mg_levels|mg_coarse|mat_mumps)_[a-z0-9_]+"),
      tells("-log_view|.*(view|monitor|converged).*"), is_number("[-+]?[0-9.]+([eE][-+]?[0-9]+)?"),
      is_word("[a-z0-9_]+"), // MUMPS' 22 is its factors on disk
      names_a_file(".*(tmpdir|prefix|file|icntl_22).*");
  constexpr std::size_t longest = 100; // std::regex recurses on every character
  std::istringstream words(options);
  std::string name;
  for (std::string word; words >> word;) {
    if (word.size() > longest) return "PETSC_OPTIONS: has a word of more than 100 characters, must have none";
    const bool is_value = word.front() != '-' || std::regex_match(word, is_number);
    if (!is_value) name = word;
    const bool may_have_value = !std::regex_match(name, tells);
    const bool is_allowed =
        is_value ? may_have_value && (std::regex_match(word, is_number) || std::regex_match(word, is_word))
                 : (name == "-log_view" || std::regex_match(name, is_solvers)) &&
                       !std::regex_match(name, names_a_file);
    if (!is_allowed)
      return "PETSC_OPTIONS: has '" + word +
             "', must be options of PETSc's solvers (-snes_, -ksp_, -pc_, -mg_levels_, -mg_coarse_, "
             "-mat_mumps_, each also after -msm_) with a number or a word, monitors without a value, or "
             "-log_view: none that names a file, a program or a library";
  }
  return "";
}

} // namespace springproof::fem_reference
