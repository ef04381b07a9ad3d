#pragma once

#include "cases/case/names.hpp"
#include "compare/client/judge.hpp"
#include "msm/design/design.hpp"

/// From a material to the numbers that an engine takes, and the error to expect: `springproof design --for`.
namespace springproof::compare {

SPRINGPROOF_ENUMERATION(Engine, jolt, xpbd, rapier, mujoco, bullet, unity, sofa, usd)

struct EngineRequest {
  Engine engine;
  msm::DesignRequest design;      ///< the material, the cell and, where it is named, the method
  bool has_method = false;        ///< otherwise the best that the engine can have
  double density = 1000;          ///< kg/m³
  ClientBudget budget{};          ///< step and iterations
  std::optional<Client> client{}; ///< in place of the engine's own adapter
};

struct EngineNumber {
  std::string name;
  double value;
  std::string unit;
};

struct EngineDesign {
  Engine engine;
  cases::LinearElastic material;
  double edge, density;
  ClientBudget budget;
  std::string design; ///< the springs'; empty where the engine takes moduli
  std::vector<EngineNumber> numbers;
  std::vector<std::string> cannot;    ///< what the engine lacks of the design, or of a body
  std::vector<std::string> warnings;  ///< the design's
  std::optional<JudgedCase> judged{}; ///< a beam, with the engine's rows behind our own
  std::string not_run{};              ///< why there is no such row

  bool has_failed() const { return judged && !judged->rows.back().worst; }
};

/// Designs for an engine, and asks it for the sag of a beam of 10 x 3 x 3 such cells under a weight that
/// lowers its tip by 7 % of its length. Without a number of iterations it is asked by its defaults and by the
/// settings of the league; the best of them takes no longer for a step than the step.
/// @throws InputError where the cell is no cube, or the engine cannot have the design that is named
EngineDesign design_for_engine(const EngineRequest& request);

Json engine_design_to_json(const EngineDesign& design);
void write_engine_design_text(std::ostream& out, const EngineDesign& design);

} // namespace springproof::compare
