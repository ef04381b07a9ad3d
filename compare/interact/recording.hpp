#pragma once

#include "cases/scene/scene.hpp"

#include <string>
#include <vector>

namespace springproof::compare {

/// Columns of a recording, a row per step with a pull: the step (from 1), the time of its end (s), centre and
/// radius of the sphere whose part of the surface is pulled, at rest (mm), the force (N).
inline const std::string recording_header = "step,time,x,y,z,radius,fx,fy,fz";
constexpr std::size_t most_recorded = 200'000; ///< steps with a pull

/// A place that was held, from its first step on, one force (N) a step.
struct Hold {
  Eigen::Vector3d centre; ///< mm
  double radius;          ///< mm
  long first_step;
  std::vector<Eigen::Vector3d> force;
};

/// Columns of a recording of tools moved by hand, a row for the end of every step (0: the start) in which one
/// moves, and for the one before: the step, its time (s), the tool's number in the case, where it is (mm).
inline const std::string tool_recording_header = "step,time,tool,x,y,z";

/// @param n_tools  the case's     @return each tool's path; empty: it stays where it begins
/// @throws cases::InputError as below
std::vector<std::vector<std::array<double, 4>>> read_tool_recording(const std::string& text,
                                                                    const std::string& path, double step,
                                                                    double end, std::size_t n_tools);

/// @param text  CSV     @param path  named in messages     @param step, end  the case's, s
/// @return at least one, in the order of their steps
/// @throws cases::InputError with the line, if it is no recording of the case's step, or ends after the case
std::vector<Hold> read_recording(const std::string& text, const std::string& path, double step, double end);

/// A dynamic case with a recording of `interact`: of tools, whose paths it becomes; or of pulls, as loads of
/// both models: the force of a step acts from just
/// after its beginning (a millionth of the step) to its end, on the part of the surface that was pulled.
/// @param text  CSV as either function above reads it     @param path  for messages
/// @throws cases::InputError with the line, if it is no recording of the case's step, or ends after the case
cases::Scene with_recording(cases::Scene scene, const std::string& text, const std::string& path);

} // namespace springproof::compare
