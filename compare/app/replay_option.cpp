#include "compare/app/replay_option.hpp"

#include "cases/case/input_file.hpp"
#include "compare/interact/replay.hpp"

namespace springproof::compare {

CLI::Option* add_replay_option(CLI::App& command, std::string& recording) {
  return command.add_option("--replay", recording,
                            "a recording of interact (NAME_pulls.csv), whose forces act on both models");
}

std::vector<Question> with_recording(std::vector<Question> questions, const std::string& recording) {
  if (recording.empty()) return questions;
  if (questions.size() != 1) throw cases::InputError("--replay: a recording is of one case");
  cases::Scene& scene = questions.front().scene;
  scene = with_recording(std::move(scene), cases::read_text_file(recording), recording);
  return questions;
}

} // namespace springproof::compare
