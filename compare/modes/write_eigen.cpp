#include "compare/modes/write_eigen.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>
#include <nlohmann/json.hpp>

namespace springproof::compare {

using Json = nlohmann::ordered_json;

namespace {

std::string line_of(const char* model, const std::vector<Eigenspace>& spaces) {
  std::string line = fmt::format("{:<5}", model);
  for (const Eigenspace& space : spaces) {
    const double value = std::abs(space.eigenvalue) < 1e-9 * spaces.back().eigenvalue ? 0 : space.eigenvalue;
    line += fmt::format("{:>12}", fmt::format("{:.4g}({})", value, space.dimension));
  }
  return line;
}

Json spaces_to_json(const std::vector<Eigenspace>& spaces) {
  Json list = Json::array();
  for (const Eigenspace& space : spaces)
    list.push_back({{"eigenvalue", space.eigenvalue}, {"multiplicity", space.dimension}});
  return list;
}

} // namespace

void write_eigenspaces_text(std::ostream& out, const EigenspaceAnalysis& analysis) {
  fmt::print(out, "eigenvalues in N/mm (multiplicity)\n{}\n{}\n", line_of("fem", analysis.fem_spaces),
             line_of("msm", analysis.msm_spaces));
  fmt::print(out, "equivalent eigenspaces\n");
  for (const Equivalence& e : analysis.equivalent)
    fmt::print(out, "  fem {} = msm {}, dimension {}, distance {}\n", e.fem_space + 1, e.msm_space + 1,
               analysis.fem_spaces[static_cast<std::size_t>(e.fem_space)].dimension, e.distance);
  fmt::print(out, "coupling: share of each fem space (row) in each msm space (column)\n");
  for (Eigen::Index i = 0; i < analysis.coupling.rows(); ++i) {
    for (Eigen::Index j = 0; j < analysis.coupling.cols(); ++j)
      fmt::print(out, "{:>7}",
                 analysis.coupling(i, j) < 1e-12 ? "." : fmt::format("{:.3f}", analysis.coupling(i, j)));
    fmt::print(out, "\n");
  }
  fmt::print(out, "N = {}, h = {:.4f}\n", analysis.fem_spaces.size(), analysis.h);
}

void write_free_modes_text(std::ostream& out, const FreeBodyModes& modes) {
  fmt::print(out, "free body, lowest deforming modes\n{:>14}{:>6}{:>14}{:>6}{:>10}{:>10}\n", "fem N/mm",
             "dim", "msm N/mm", "dim", "msm/fem", "angle °");
  for (const ModePair& pair : modes.pairs)
    fmt::print(out, "{:>14.6g}{:>6}{:>14.6g}{:>6}{:>10.4f}{:>9.2f}\n", pair.fem.eigenvalue,
               pair.fem.dimension, pair.msm.eigenvalue, pair.msm.dimension, pair.ratio, pair.angle_degrees);
}

Json eigenspaces_to_json(const EigenspaceAnalysis& analysis) {
  Json equivalent = Json::array(), coupling = Json::array();
  for (const Equivalence& e : analysis.equivalent)
    equivalent.push_back(
        {{"fem_space", e.fem_space + 1}, {"msm_space", e.msm_space + 1}, {"distance", e.distance}});
  for (Eigen::Index i = 0; i < analysis.coupling.rows(); ++i) {
    const Eigen::VectorXd row = analysis.coupling.row(i);
    coupling.push_back(std::vector<double>(row.data(), row.data() + row.size()));
  }
  return {{"h", analysis.h},
          {"fem", spaces_to_json(analysis.fem_spaces)},
          {"msm", spaces_to_json(analysis.msm_spaces)},
          {"equivalent", equivalent},
          {"coupling", coupling}};
}

Json free_modes_to_json(const FreeBodyModes& modes) {
  Json list = Json::array();
  for (const ModePair& pair : modes.pairs)
    list.push_back({{"fem_eigenvalue", pair.fem.eigenvalue},
                    {"fem_multiplicity", pair.fem.dimension},
                    {"msm_eigenvalue", pair.msm.eigenvalue},
                    {"msm_multiplicity", pair.msm.dimension},
                    {"ratio", pair.ratio},
                    {"angle_degrees", pair.angle_degrees}});
  return list;
}

} // namespace springproof::compare
