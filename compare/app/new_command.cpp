#include "cases/case/error.hpp"
#include "cases/case/names.hpp"
#include "compare/app/commands.hpp"
#include "compare/provenance/machine.hpp"
#include "compare/provenance/whole_file.hpp"

#include <boost/algorithm/string/replace.hpp>
#include <filesystem>
#include <iostream>

namespace springproof::compare {

namespace {

namespace fs = std::filesystem;

struct NewOptions {
  std::string name;
  std::string template_name = "box";
};

void check_name(const std::string& name) {
  const bool is_clean =
      !name.empty() && name.size() <= 200 && name.front() != '.' && name.front() != '-' &&
      name.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-.") ==
          std::string::npos;
  if (!is_clean)
    throw cases::InputError(
        "new: \"" + name +
        "\" is no name: up to 200 letters, digits, _ - and . make one, and the file is NAME.toml in "
        "this folder");
}

int write_new_case(const NewOptions& options) {
  check_name(options.name);
  const std::map<std::string, std::string> templates = case_files_in("templates");
  const auto chosen = templates.find(options.template_name);
  if (chosen == templates.end()) {
    std::vector<std::string> known;
    for (const auto& [name, file] : templates) known.push_back(name);
    throw cases::InputError("new: there is no template \"" + options.template_name + "\", allowed are " +
                            cases::alternatives(known));
  }
  std::map<fs::path, fs::path> copies; // from, to: the case's file, and another of the same name beside it
  for (const auto& entry : fs::directory_iterator(fs::path(chosen->second).parent_path()))
    if (entry.path().stem() == options.template_name)
      copies[entry.path()] = options.name + entry.path().extension().string();
  for (const auto& [from, to] : copies)
    if (fs::exists(fs::symlink_status(to)))
      throw cases::InputError("new: " + to.string() + " exists, and nothing is overwritten");
  if (mpi_rank() != 0) return 0;
  for (const auto& [from, to] : copies) {
    const std::string text = boost::replace_all_copy(read_file(from), "TEMPLATE", options.name);
    write_file(to.string(), [&](std::ostream& out) { out << text; });
    std::cout << "wrote " << to.string() << '\n';
  }
  std::cout << "next: springproof run " << options.name << ".toml\n";
  return 0;
}

} // namespace

void add_new_command(CLI::App& program, Action& chosen) {
  const auto [command, options] = add_command<NewOptions>(
      program, chosen, "new", "write a commented case file to start from", write_new_case);
  command->add_option("name", options->name, "of the case; the file is NAME.toml")->required();
  command
      ->add_option("--template", options->template_name, "box | layers | mesh | organ | tetrahedra | voxels")
      ->capture_default_str();
}

} // namespace springproof::compare
