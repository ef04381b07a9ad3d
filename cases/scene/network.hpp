#pragma once

#include "cases/case/case.hpp"

#include <functional>

/// A user's own spring network: `design = "network"`, `file = "NAME.csv"` in [msm].
namespace springproof::cases {

/// A spring between two nodes of the mesh, by their numbers.
struct NetworkSpring {
  int a, b;
  double stiffness;                    ///< N/mm, > 0
  std::optional<double> rest_length{}; ///< mm, > 0; absent: the distance of the nodes at rest
  std::optional<double> exponent{};    ///< power-log law; absent: Hooke's
};

/// Reads lines of node a, node b (numbers from 0, in the order of the .vtu files that --out writes),
/// stiffness in N/m, and perhaps rest length in mm and exponent of the power-log law. These two may be empty.
/// Empty lines, those that begin with #, and a heading (the first line alone may be one) are skipped.
/// @param text  the file's content    @param name  the file's, for messages    @param n_nodes  the mesh's
/// @throws InputError with the line and the field
std::vector<NetworkSpring> read_network(const std::string& text, const std::string& name,
                                        std::size_t n_nodes);

/// Likely mistakes in a network, with the number of springs: nodes that several springs join, and rest
/// lengths more than 10 % from the distance of the nodes.
std::vector<std::string> doubts_of(const std::vector<NetworkSpring>& springs,
                                   const std::function<Eigen::Vector3d(int)>& node);

} // namespace springproof::cases
