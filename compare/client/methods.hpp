#pragma once

#include "cases/scene/scene.hpp"
#include "compare/client/ask_client.hpp"
#include "compare/table/json.hpp"

#include <string>
#include <variant>
#include <vector>

/// Methods of our own that step a case as simulators do, as command lines and leagues name them.
namespace springproof::compare {

/// How springs, or finite elements, are stepped.
using Steps = std::variant<cases::RealTime, cases::ElementRealTime>;

/// One of both models' methods.
using AnyMethod = std::variant<cases::StepMethod, cases::ElementMethod>;

/// The name of a method: of springs as in [msm] real_time, of finite elements with "fem." before it.
std::string name_of(const AnyMethod& method);
std::optional<AnyMethod> method_called(const std::string& name);
/// All names, of springs first.
std::vector<std::string> method_names();
AnyMethod method_of(const Steps& steps);

/// "xpbd, 1 iteration, 50 substeps", without what explicit methods or the steps have not.
std::string text_of(const Steps& steps);

/// Steps by a method within a budget, but for its substeps.
Steps steps_in(const AnyMethod& method, const ClientBudget& budget);

/// Iterations, substeps, and of a body without [dynamics] the step and the damping: what a row says of steps.
Json settings_of(const Steps& steps, const cases::Case& definition);

/// Gives a case steps that it may not have asked for.
/// @return what of it they ignore
std::vector<std::string> set_steps(cases::Case& definition, const cases::RealTime& real_time);
/// The same of the elements of a scene: on its own mesh, of an element that the method takes.
/// @throws cases::InputError where the method does not take the mesh, a material or a measure
std::vector<std::string> set_steps(cases::Scene& scene, const cases::ElementRealTime& real_time);

/// A method as a command line has it.
struct NamedMethod {
  std::string name; ///< as it was typed
  Steps steps;
};

/// `NAME[:ITERATIONS[:SUBSTEPS]]` of the command line; what it leaves out is the budget's.
/// @throws cases::InputError saying what is allowed
NamedMethod method_of(const std::string& argument, const ClientBudget& budget);

} // namespace springproof::compare
