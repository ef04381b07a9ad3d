#pragma once

#include "compare/peers/external_side.hpp"

/// A motion that another program computed: its times, and how it becomes an answer.
namespace springproof::compare {

/// The times (s) at which an answer has bodies: the start and the end of every step. At rest there are none.
std::vector<double> frame_times(const cases::Scene& scene);

/// Takes a motion into a solution, recorded as ours is.
/// @param body  displacements (mm) of all nodes at the k-th time, called in the order of the times
void record_motion(const cases::Scene& scene, cases::Solution& solution,
                   const std::function<std::vector<Eigen::Vector3d>(std::size_t k, double time)>& body);

/// One time of a motion in files.
struct GivenBody {
  double time;       ///< s
  std::string where; ///< for messages: the file, or "file:line"
  std::function<std::vector<GivenDisplacement>()> nodes;
};

/// The times of a motion. Files are looked up, and read only when the nodes of their time are asked for.
///
/// - A .pvd: its files must be in its folder or below.
/// - A .csv: the header time,x,y,z,ux,uy,uz; s and mm, one time after the other.
/// - A folder: the files and times of its times.csv (header file,time); without one its numbered files, whose
///   number is that of the step.
/// @param step  of the case, s   @param array  as for read_displacements()
/// @throws InputError where, what and what is allowed; if times do not ascend
std::vector<GivenBody> read_motion(const std::string& path, double step, const std::string& array);

/// The motion in files as an answer to a case, which needs all of frame_times(); other times are left out.
/// @throws InputError as read_motion() and match_nodes(), or if a time is missing
cases::Solution motion_from(const cases::Scene& scene, const std::string& path, const std::string& array);

} // namespace springproof::compare
