#pragma once

#include "compare/solve/kept.hpp"
#include "compare/solve/progress.hpp"
#include "compare/solve/solve.hpp"

#include <functional>

/// Cases solved side by side on the machine's cores: what the commands that solve many cases share.
namespace springproof::compare {

/// Reads every case and its mesh.
/// @param settings  values of `--set`   @throws InputError
std::vector<Question> read_questions(const std::vector<std::string>& case_files,
                                     const std::vector<std::string>& settings, const Request& request);

struct SolveOptions {
  int n_workers = 0;                      ///< worker processes; 0: one per core, as far as memory allows
  std::string program = "/proc/self/exe"; ///< whose hidden command `worker` serves
  ProgressLine* line = nullptr;           ///< that expects these questions already; null: one for them alone
};

/// Answers every question; what an earlier command has left is taken up, what is solved is kept as soon as it
/// is. Numbers do not depend on the number of workers, to the last bit. Questions are
/// handed out in the order of their estimated time, the longest first; a worker gets the scene itself and
/// reads no file but those that FinishedCases keeps. Whatever goes wrong, a crash of the worker included, is
/// a failed side with its reason, and the others go on. Under MPI with several ranks this process answers one
/// question after the other, each distributed (collective).
/// @param solve_fem  as for solve(); workers have their own
/// @throws InputError before anything is solved, if a question needs more memory than there is
std::vector<Answers> answer_all(const std::vector<Question>& questions, const FinishedCases& finished,
                                SolveFem solve_fem, const SolveOptions& options);

/// What a worker does with the bytes of a question and the folder of FinishedCases.  @return the answers'
/// bytes
/// @throws cereal's exception for bytes that are no question
std::string answer_job(const std::string& bytes, SolveFem solve_fem);

/// A question as the tables name it: a case file, settings for it, and one side or both.
struct SolveJob {
  std::string case_file;             ///< as read_case() opens it
  std::vector<std::string> settings; ///< as for `run --set`
  std::optional<cases::Side> only;   ///< absent: both sides
  bool operator<(const SolveJob& other) const;
};

/// A job's scene, and what solving it found.
struct Solved {
  cases::Scene scene;
  Answers answers;
};

/// The jobs' questions, without those whose case cannot be read.
std::vector<Question> questions_of(const std::vector<SolveJob>& jobs);

/// Where the answers to questions come from: answer_all(), or shards that have solved them.
using AnswerQuestions = std::function<std::vector<Answers>(const std::vector<Question>&)>;

/// Answers the jobs' questions. A job whose case cannot be read has failed, with the reason.
std::vector<Solved> solve_jobs(const std::vector<SolveJob>& jobs, const AnswerQuestions& answer);

int cores(); ///< the machine's cores, at least 1

} // namespace springproof::compare
