#include "compare/report/traced.hpp"

#include "compare/report/html.hpp"

#include <fmt/format.h>

namespace springproof::compare::html {

std::string provenance(const Trace& trace) {
  std::string text;
  if (!trace.case_file.empty()) text += "case: " + trace.case_file + "\n";
  for (const std::string& setting : trace.settings) text += "setting: " + setting + "\n";
  return escape(text + "command: " + trace.command);
}

std::string traced(const std::string& text, const Trace& trace) {
  if (trace.command.empty()) return escape(text);
  return fmt::format("<details><summary title='{}'>{}</summary><code>{}</code></details>", provenance(trace),
                     escape(text), escape(trace.command));
}

} // namespace springproof::compare::html
