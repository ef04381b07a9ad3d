#include "compare/sweep/sentences.hpp"
#include "compare/sweep/write_sweep.hpp"

namespace springproof::compare {

namespace {

const char* what(Error error) {
  return error == Error::field ? "displacement field" : "worst measure";
}

const char* what(Clock clock) {
  return clock == Clock::first_answer ? "first answer (setup and solve from rest)"
                                      : "re-solve after a load change of 5 %";
}

std::vector<std::string> speed_sentences(const Sweep& sweep, Error error, Clock clock) {
  const std::vector<Point> points = points_of(sweep, error, clock);
  const double uncertainty = uncertainty_percent(*sweep.reference, error);
  std::vector<std::string> sentences;
  for (const double percent : {10., 5., 1.})
    sentences.push_back(fastest_sentence(points, percent, uncertainty));
  for (const double seconds : {1e-3, 16e-3, 100e-3})
    sentences.push_back(most_accurate_sentence(points, seconds, uncertainty));
  return sentences;
}

std::vector<std::string> floor_sentences(const Sweep& sweep, Error error) {
  std::vector<std::string> levels, sentences;
  for (const auto& cells : sweep.plan.levels) levels.push_back(cells_name(cells));
  for (const std::string& method : methods_of(sweep))
    if (method.rfind("springs ", 0) == 0)
      sentences.push_back(floor_sentence(method, levels, errors_by_level(sweep, method, error)));
  return sentences;
}

} // namespace

std::vector<Conclusions> conclusions(const Sweep& sweep) {
  static_assert(load_change == 0.05, "a heading here says so");
  if (!sweep.reference)
    return {{"nothing can be concluded without a reference", {sweep.reason_without_reference}}};
  std::vector<Conclusions> all;
  for (const Error error : {Error::field, Error::worst_measure}) {
    if (error == Error::worst_measure && sweep.reference->measures.empty()) continue;
    for (const Clock clock : {Clock::first_answer, Clock::re_solve})
      all.push_back({std::string(what(error)) + ", " + what(clock), speed_sentences(sweep, error, clock)});
    all.push_back({std::string(what(error)) + ", more cells", floor_sentences(sweep, error)});
  }
  return all;
}

} // namespace springproof::compare
