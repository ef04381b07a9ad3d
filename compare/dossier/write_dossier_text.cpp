#include "compare/dossier/dossier.hpp"
#include "compare/provenance/print.hpp"
#include "compare/table/table.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace springproof::compare {

namespace {

struct SectionName {
  const char *key, *name;
};
constexpr SectionName sections[] = {{"context", "context"},
                                    {"code_verification", "code verification"},
                                    {"calculation_verification", "calculation verification"},
                                    {"validation", "validation"},
                                    {"applicability", "applicability"}};

template<class Is>
std::size_t count_if(const Json& list, const Is& is_it) {
  return static_cast<std::size_t>(std::count_if(list.begin(), list.end(), is_it));
}

bool is_own(const Json& gate) {
  return gate["name"].get<std::string>().rfind("springproof/", 0) == 0;
}

std::string gates_text(const Json& document, bool own) {
  const Json& all = document["gates"];
  const std::size_t n = count_if(all, [&](const Json&gate) { return is_own(gate) == own; }),
                    n_met = count_if(
                        all, [&](const Json&gate) { return is_own(gate) == own && gate["met"].get<bool>(); });
  return fmt::format("{} of {} gates met", n_met, n);
}

std::string content_of(const Json& document, const std::string& key) {
  if (key == "context") {
    const std::size_t n = document["context"]["cases"].size();
    return fmt::format("{} case{}", n, n == 1 ? "" : "s");
  }
  if (key == "code_verification") {
    const Json& code = document[key];
    return fmt::format("own cases: {}; orders of convergence: {}; values of other programs: {}",
                       gates_text(document, true),
                       count_if(code["orders"], [](const Json& one) { return !one["order"].is_null(); }),
                       count_if(code["peers"], [](const Json& one) { return one["status"] == "converged"; }));
  }
  if (key == "calculation_verification") {
    std::size_t n = 0, n_limits = 0;
    for (const Json& one : document[key]) {
      n += one["measures"].size();
      n_limits += count_if(one["measures"], [](const Json& m) { return !m["fem_limit"].is_null(); });
    }
    return fmt::format("limits: {} of {}; {}", n_limits, n, gates_text(document, false));
  }
  if (key == "validation")
    return fmt::format("measured values: {}; published gates: {}", document[key]["rows"].size(),
                       document[key]["published"].size());
  return fmt::format("warnings: {}", [&] {
    std::size_t n = 0;
    for (const Json& one : document[key]) n += one["warnings"].size();
    return n;
  }());
}

} // namespace

void write_dossier_text(std::ostream& out, const Json& document) {
  const Json& missing = document["missing"];
  Json rows = Json::array();
  for (const auto& [key, name] : sections)
    rows.push_back({{"section", name},
                    {"holds", content_of(document, key)},
                    {"missing", count_if(missing, [k = std::string(key)](const Json& one) {
                       return one["section"] == k;
                     })}});
  write_table(out, columns_of("section holds{:<} missing"), rows);
  for (const Json& gate : document["gates"])
    if (!gate["met"].get<bool>())
      write_paragraph(out,
                      fmt::format("MISSED {}: {}", gate["name"].get<std::string>(),
                                  gate["reason"].is_null() ? "" : gate["reason"].get<std::string>()),
                      "", "  ");
  for (const Json& one : missing)
    write_paragraph(out,
                    fmt::format("missing: {}{} Filled by {}.",
                                one["case"].is_null() ? "" : one["case"].get<std::string>() + ": ",
                                one["what"].get<std::string>() + ".", one["filled_by"].get<std::string>()),
                    "", "  ");
}

} // namespace springproof::compare
