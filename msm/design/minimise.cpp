#include "msm/design/minimise.hpp"

#include <glog/logging.h>

namespace springproof::msm {

ceres::Solver::Summary minimise(ceres::Problem& problem, ceres::Solver::Options options) {
  options.linear_solver_type = ceres::DENSE_QR;
  options.logging_type = ceres::SILENT;
  FLAGS_minloglevel = google::GLOG_FATAL; // of Ceres, whatever logging_type
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return summary;
}

} // namespace springproof::msm
