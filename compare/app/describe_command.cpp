#include "compare/app/commands.hpp"
#include "compare/provenance/machine.hpp"
#include "compare/write/quote.hpp"

#include <fmt/format.h>
#include <iostream>
#include <regex>

// The man page and the completion for bash, from the options that --help is made of. The build writes both.
namespace springproof::compare {

namespace {

std::vector<const CLI::Option*> options_of(const CLI::App& command, bool are_positional) {
  return command.get_options(
      [&](const CLI::Option* option) { return option->get_positional() == are_positional; });
}

/// "--name", and "-n" where there is one.
std::vector<std::string> names_of(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  return names;
}

/// The words that an option takes: those of "TEXT:{a,b}".
std::vector<std::string> choices_of(const CLI::Option& option) {
  static const std::regex in_braces("\\{([^}]*)\\}");
  std::smatch found;
  const std::string type = option.get_type_name();
  return std::regex_search(type, found, in_braces) ? CLI::detail::split(found[1].str(), ',')
                                                   : std::vector<std::string>();
}

std::string joined(const std::vector<std::string>& words, const char* between) {
  return fmt::format("{}", fmt::join(words, between));
}

/// What stands for an option's value; nothing for a flag.
std::string placeholder(const CLI::Option& option) {
  if (option.get_items_expected_max() == 0) return "";
  const std::vector<std::string> choices = choices_of(option);
  const std::string type = option.get_type_name();
  const std::string value = !choices.empty() && choices.size() <= 4 ? joined(choices, "|")
                            : type.rfind("TEXT", 0) == 0            ? "TEXT"
                            : type.rfind("FLOAT", 0) == 0           ? "NUMBER"
                                                                    : "N";
  return option.get_items_expected_max() > 1 ? value + " ..." : value;
}

/// Text in roff, none of whose characters is a command's.
std::string in_roff(const std::string& text) {
  return (text.rfind('.', 0) == 0 ? "\\&" : "") +
         escaped(text, {{'\\', "\\e"}, {'-', "\\-"}, {'\'', "\\(aq"}});
}

void write_options(std::ostream& out, const CLI::App& command) {
  for (const CLI::Option* option : options_of(command, false)) {
    const std::string value = placeholder(*option);
    out << ".TP\n\\fB" << in_roff(joined(names_of(*option), ", ")) << "\\fR"
        << (value.empty() ? "" : " \\fI" + in_roff(value) + "\\fR") << '\n'
        << in_roff(option->get_description());
    const std::vector<std::string> choices = choices_of(*option);
    if (choices.size() > 4) out << " (" << in_roff(joined(choices, ", ")) << ')';
    out << '\n';
  }
}

void write_man_page(std::ostream& out, const CLI::App& program) {
  out << ".TH SPRINGPROOF 1 \"\" \"springproof " << program_version() << "\" \"User Commands\"\n.SH NAME\n"
      << "springproof \\- mass\\-spring models of soft tissue against finite elements, measured\n"
      << ".SH SYNOPSIS\n\\fBspringproof\\fR \\fICOMMAND\\fR [\\fIOPTIONS\\fR]\n.br\n"
      << "\\fBspringproof\\fR \\fICOMMAND\\fR \\fB\\-\\-help\\fR\n"
      << ".SH DESCRIPTION\nSolves each case twice, with springs and with finite elements, evaluates the same "
         "measures on both, and prints the error. A case is a TOML file; \\fBspringproof new\\fR writes one "
         "to "
         "start from.\n";
  for (const CLI::App* command : commands_of(program)) {
    out << ".SH " << in_roff(command->get_name()) << "\n\\fBspringproof " << in_roff(command->get_name())
        << "\\fR";
    for (const CLI::Option* positional : options_of(*command, true)) {
      const std::string name =
          positional->get_name(true) + (positional->get_items_expected_max() > 1 ? " ..." : "");
      out << " \\fI" << in_roff(positional->get_required() ? name : "[" + name + "]") << "\\fR";
    }
    out << " [\\fIOPTIONS\\fR]\n.PP\n" << in_roff(command->get_description()) << ".\n";
    write_options(out, *command);
  }
  out << ".SH EXIT STATUS\n.TP\n0\ndone\n.TP\n1\na solve failed, or an expectation was missed\n"
         ".TP\n2\nwrong input or usage\n.TP\n3\ninternal error\n"
         ".SH ENVIRONMENT\n.TP\n\\fBPETSC_OPTIONS\\fR\noptions for PETSc\\(aqs solvers; those that name "
         "files, "
         "programs or libraries are refused\n"
         ".TP\n\\fBSPRINGPROOF_CASES\\fR\nfolder to take the thesis\\(aqs cases and published values from, "
         "in "
         "place of the installed one\n"
         ".TP\n\\fBNO_COLOR\\fR\nif set, verdicts on a terminal are not coloured\n";
}

/// A list for a shell's case statement and words for compgen.
void write_completion(std::ostream& out, const CLI::App& program) {
  std::vector<std::string> commands;
  for (const CLI::App* command : commands_of(program)) commands.push_back(command->get_name());
  out << "# Completion of springproof's commands, options and their values for bash.\n_springproof() {\n"
         "  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} words=\n"
         "  case \"${COMP_WORDS[1]} $before\" in\n";
  for (const CLI::App* command : commands_of(program))
    for (const CLI::Option* option : options_of(*command, false)) {
      const std::vector<std::string> choices = choices_of(*option);
      if (option->get_items_expected_max() == 0) continue;
      for (const std::string& name : names_of(*option))
        out << "    \"" << command->get_name() << ' ' << name << "\") COMPREPLY=($(compgen -W \""
            << joined(choices, " ") << "\" -- \"$word\")); return ;;\n";
    }
  out << "  esac\n  if [ \"$COMP_CWORD\" -eq 1 ]; then\n    words=\"" << joined(commands, " ")
      << " --help --version\"\n  else\n    case ${COMP_WORDS[1]} in\n";
  for (const CLI::App* command : commands_of(program)) {
    std::vector<std::string> names;
    for (const CLI::Option* option : options_of(*command, false))
      for (const std::string& name : names_of(*option)) names.push_back(name);
    out << "      " << command->get_name() << ") words=\"" << joined(names, " ") << "\" ;;\n";
  }
  out << "    esac\n    case $word in -*) ;; *) return ;; esac\n  fi\n"
         "  COMPREPLY=($(compgen -W \"$words\" -- \"$word\"))\n}\n"
         "# Where there is nothing to propose, names of files.\n"
         "complete -o default -F _springproof springproof\n";
}

struct DescribeOptions {
  const CLI::App* program = nullptr;
  std::string form;
};

int describe(const DescribeOptions& options) {
  (options.form == "man" ? write_man_page : write_completion)(std::cout, *options.program);
  return 0;
}

} // namespace

void add_describe_command(CLI::App& program, Action& chosen) {
  const auto [command, options] =
      add_command(program, chosen, "describe", "the man page, or the completion for bash", describe);
  command->group(""); // for the build
  command->add_option("form", options->form)->required()->check(CLI::IsMember({"man", "bash"}));
  options->program = &program;
}

} // namespace springproof::compare
