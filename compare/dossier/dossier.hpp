#pragma once

#include "compare/fit/fit.hpp"
#include "compare/gates/comparison.hpp"
#include "compare/peers/peer_study.hpp"
#include "compare/study/error_budget.hpp"

#include <iosfwd>

/// What is handed in with a simulation: what it is for, why the code, the calculation and the model can be
/// believed, how far, and what nobody has shown: `springproof dossier`.
namespace springproof::compare {

/// What only people know; empty: they did not say.
struct DossierContext {
  std::string question;    ///< that the simulation is to answer
  std::string role;        ///< its answer's, in the decision, beside other evidence
  std::string consequence; ///< what a wrong answer does
};

struct DossierRequest {
  FitCases cases; ///< none held out
  int meshes = 0; ///< for the finite elements' limits; 0: as the cases ask
  DossierContext context;
  std::string measured;               ///< file of data, as read_fit_data() has them; empty: none
  std::vector<std::string> uncertain; ///< KEY=SIGMA: a key of the cases and its standard uncertainty
  std::vector<std::string> peers;     ///< "ccx", "getfem": asked about the cases too
  std::vector<std::string> own_files; ///< the program's own cases, for verify_code()
};

/// How far one key of a case, changed by its standard uncertainty, moves the measures.
struct InputEffect {
  std::string key;
  double value, deviation;
  std::vector<std::optional<double>> fem, msm; ///< half of what both signs differ by; one per measure
  std::string reason{};                        ///< why there are none
};

/// A case with all that was found of its answers' errors.
struct StudiedCase {
  Comparison comparison;
  ErrorBudgets budgets;
  std::vector<InputEffect> inputs{};
  std::optional<PeerStudy> second_code{}; ///< when asked for
};

/// The most that a model's value is expected to err by its own mesh, step and iterations.
struct NumericalBar {
  std::optional<double> size{}; ///< in the measure's unit
  std::string reason{};         ///< why it is not known
};

/// The sizes of the parts of a budget but the law's, with their uncertainties, in the unit of the value.
NumericalBar numerical_bar(const ErrorBudget& budget, double value);

/// A measurement beside one model's value. Source of the terms: the validation difference and its uncertainty
/// as ASME V&V 20 defines them; the numerical part is a bound here, and counts as two standard deviations.
struct ModelAgainstDatum {
  std::optional<double> value{};
  std::optional<double> difference{}; ///< value - datum
  NumericalBar numerical{};
  std::optional<double> input{}; ///< standard uncertainty by the keys that are uncertain; absent: none are
  /// sqrt(numerical² + (2 input)² + (2 sigma)²) of those that are known; absent where none is
  std::optional<double> uncertainty{};
  bool is_complete = false; ///< all three are known
  std::string reason{};     ///< why there is no value
};

struct ValidatedDatum {
  std::string case_name;
  std::vector<std::string> settings; ///< the row's alone
  std::string measure, unit;
  int line = 0;
  double value = 0;
  std::optional<double> deviation{}; ///< standard uncertainty of the measurement
  ModelAgainstDatum fem{}, msm{};
};

/// The uncertainty of a difference of these parts.
/// @param deviation  of the measurement
void combine(ModelAgainstDatum& model, std::optional<double> deviation);

struct Validation {
  std::string file;          ///< empty: there are no data
  std::string description{}; ///< comments at the beginning of the file
  std::vector<ValidatedDatum> data{};
};

/// Holds both models against data.
/// @param of_state  the studied case of each of the data's states    @throws InputError if it cannot be read
Validation validate(const std::string& file, const FitData& data,
                    const std::vector<const StudiedCase*>& of_state);

/// The comments that a file of data begins with, as one line.
std::string comments_of(const std::string& text);

/// Values of one model on meshes that are refined, and the order in which they converge.
struct ObservedOrder {
  std::string case_name, model, measure, unit;
  std::vector<double> values; ///< from coarse to fine
  std::optional<int> formal;  ///< the element's; absent: the model has none of its own
  std::optional<double> order{};
  std::string reason{}; ///< why none is seen
};

/// A row of the table of tests in docs/developing/verification.md.
struct ProjectTest {
  std::string part, checked, against, where; ///< the last may be empty
};
/// Rows of the tables with a column "what is checked", in the order of the page.
std::vector<ProjectTest> project_tests(const std::string& markdown);

/// The program's own cases with an answer that is known, solved now.
struct CodeVerification {
  std::vector<Comparison> cases; ///< CalculiX has answered those that it has
  std::vector<ObservedOrder> orders;
  std::vector<std::pair<std::string, PeerStudy>> second_codes; ///< with the case's name
  std::vector<ProjectTest> tests;                              ///< the project's; not run here
};

/// Solves the program's own cases, those of them that expect what is exact, a limit or another program's.
CodeVerification verify_code(const std::vector<std::string>& files, const AnswerQuestions& answer);

struct Dossier {
  DossierContext context;
  std::vector<std::string> settings; ///< the command's
  CodeVerification code;
  std::vector<StudiedCase> cases; ///< those that were given
  Validation validation;
  bool has_uncertain_keys = false;

  /// Nothing failed, and every gate is met.
  bool is_sound() const;
};

/// @param answer  solves the cases that are given; the program's own are solved by `answer_own`
/// @throws InputError for a case, data or a key that has no meaning
Dossier make_dossier(const DossierRequest& request, const AnswerQuestions& answer,
                     const AnswerQuestions& answer_own);

/// The document: provenance, "method", "context", "code_verification", "calculation_verification",
/// "validation", "applicability", "gates" and "missing". A number's "gates" are names in "gates"; an empty
/// list says that no gate holds it.
Json dossier_to_json(const Dossier& dossier);

/// What each section has, and all that is missing.
/// @param document  of dossier_to_json()
void write_dossier_text(std::ostream& out, const Json& document);

} // namespace springproof::compare
