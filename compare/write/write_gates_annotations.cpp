#include "compare/write/write_gates.hpp"

#include "cases/case/names.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

namespace springproof::compare {

namespace {

/// GitHub's escapes: in values of properties a colon and a comma would end them too.
std::string escaped(const std::string& text, const std::string& special) {
  std::string result;
  for (const char c : text)
    if (special.find(c) != std::string::npos)
      result += fmt::format("%{:02X}", static_cast<unsigned char>(c));
    else
      result += c;
  return result;
}

void annotate(std::ostream& out, const char* level, const std::string& file, int line,
              const std::string& title, const std::string& message) {
  const std::string in_message = "%\r\n", in_property = "%\r\n:,";
  fmt::print(out, "::{} file={},line={},title={}::{}\n", level, escaped(file, in_property), line,
             escaped(title, in_property), escaped(message, in_message));
}

} // namespace

void write_gates_annotations(std::ostream& out, const std::vector<GatedCase>& cases) {
  for (const GatedCase& judged : cases) {
    for (const std::string& failure : judged.failures)
      annotate(out, "error", judged.file, 1, judged.name, failure);
    for (const Gate& gate : judged.gates) {
      const cases::Expectation& expected = gate.judgement.expectation;
      // An expectation of the command line stands nowhere; the case's first line is as near as can be.
      const int line = expected.where.line > 0 ? expected.where.line : 1;
      const std::string title = fmt::format("{} ({})", judged.name, cases::name_of(expected.reference));
      if (!gate.met()) annotate(out, "error", judged.file, line, title, describe(gate));
      if (!gate.warning.empty())
        annotate(out, "warning", judged.file, line, title, expected.measure + ": " + gate.warning);
    }
  }
}

} // namespace springproof::compare
