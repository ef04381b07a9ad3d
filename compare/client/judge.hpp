#pragma once

#include "compare/client/methods.hpp"
#include "compare/study/error_budget.hpp"
#include "compare/study/study.hpp"
#include "compare/table/json.hpp"

#include <ostream>

/// Clients held against the same finite elements as our own springs: `springproof judge`.
namespace springproof::compare {

inline const std::string fem_model = "finite elements", springs_model = "springs"; ///< names of our own rows

/// One way to answer a case: the finite elements on the case's mesh, our springs, these stepped as simulators
/// do, or a client.
struct JudgedRow {
  std::string model;                    ///< "finite elements", "springs", the method's or the client's name
  std::optional<Introduction> client{}; ///< a method's, or a client's that came to it
  std::string command{};                ///< a client's
  std::string chosen{};                 ///< in a league: "defaults", or how the settings were found
  std::string failure{};                ///< why there is no answer; empty where there is one
  std::optional<double> worst{};        ///< largest |error| of the measures with its sign, percent
  std::optional<double> bar{};          ///< points that the limit leaves of it
  std::string worst_at{};               ///< the measure
  std::optional<double> volume{};       ///< error of the body's volume, percent of the reference's
  std::optional<double> milliseconds_a_step{};
  std::optional<bool> in_real_time{}; ///< its step takes at most the time that it advances
  std::optional<double> residual{};   ///< in a motion of springs the largest that a step has left, relative
  std::optional<SurfaceMotion> surface{}; ///< there in motions of cases with a [surface]
  std::optional<double> rests_after{};    ///< s of model time; absent where it has not come to rest
  bool is_at_rest = true;
  std::vector<std::string> warnings{};
  std::vector<MeasuredValue> measures{};
  std::optional<ErrorBudget> parts{}; ///< in a league: of the error at `worst_at`

  std::string status() const;
};

struct JudgedCase {
  std::string name;
  bool is_motion;
  bool is_converged; ///< errors are from the finite elements' limit, else from the same mesh
  std::vector<JudgedRow> rows;

  bool has_failed() const;
};

/// Whether rows tell where their errors come from.
enum class Parts { left_out, told };

/// A case whose finite elements are solved, once, for rows to be held against them.
class Judge {
 public:
  /// @param meshes  meshes of the finite elements' limit, as in Request
  /// @throws cases::InputError when the case has no measure
  Judge(cases::Scene scene, int meshes, Parts parts = Parts::left_out);
  /// The finite elements and our springs.
  /// @throws cases::InputError when there are no springs
  JudgedCase own(const ClientBudget& budget) const;
  JudgedRow ask(const Client& client, const ClientBudget& budget) const;
  /// Our springs or elements, stepped by a method: what it ignores of the case is said, as a client's.
  JudgedRow step(const Steps& steps, const ClientBudget& budget) const;

 private:
  cases::Scene scene_;
  Answers fem_;
  Parts parts_;
  const SpringLattices* lattices() const;    ///< null: there are none
  std::optional<SpringLattices> lattices_{}; ///< where rows tell their parts, of a body at rest
};

/// Own rows, and one for each method and client.
JudgedCase judge_clients(const cases::Scene& scene, const std::vector<NamedMethod>& methods,
                         const std::vector<Client>& clients, const ClientBudget& budget, int meshes);

Json row_to_json(const JudgedRow& row);
/// Warnings of a row, what its client says of itself, and why there is no answer.
std::vector<std::string> notes_of(const JudgedRow& row);
Json judged_to_json(const std::vector<JudgedCase>& cases, const ClientBudget& budget);
void write_judged_text(std::ostream& out, const JudgedCase& judged);
void write_judged_csv(std::ostream& out, const std::vector<JudgedCase>& cases);

} // namespace springproof::compare
