#pragma once

#include "msm/design/design.hpp"

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

namespace springproof::compare {

/// How the command line names a material, a cell and a method.
struct DesignOptions {
  std::string case_file;
  std::vector<std::string> settings; ///< keys of the case
  double youngs_modulus = 0,
         poissons_ratio = -2; ///< as if left out: both are required without another material
  double edge = 1;
  double split = -1; ///< left out
  std::string method;
  std::string element = "q1";
  std::vector<double> ogden_mu, ogden_alpha, mooney_rivlin, yeoh;
  double neo_hookean = 0;
  std::string curve_file;
  std::string curve_strain, curve_stress, curve_unit; ///< names of its columns' msm::CurveStrain and so on
  std::optional<double> largest_strain;
  std::vector<std::string> paths;   ///< paths of the multi-load method; empty: all
  std::vector<double> strain_range; ///< two, or left out
  std::string law;                  ///< law of the multi-load method; empty: the case's or Hooke's
  bool springs_only = false;        ///< the multi-load method without its volume term
};

void add_design_options(CLI::App& command, DesignOptions& options);

/// Names of designs, or "all", as --designs.
CLI::Option* add_designs_option(CLI::App& command, std::vector<std::string>& names, const std::string& text);

/// How many materials the options name, apart from a case file's.
int n_materials(const DesignOptions& options);

/// The designs that are asked for; "all": every one that is made from a material, and the case's own.
std::vector<cases::Design> designs_of(const std::vector<std::string>& names, const cases::Case& definition);

/// @throws InputError for a material that is missing, given twice or has no meaning
msm::DesignRequest request_from(const DesignOptions& options);

} // namespace springproof::compare
