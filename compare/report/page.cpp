#include "compare/report/pages.hpp"

#include "cases/case/installation.hpp"
#include "compare/provenance/whole_file.hpp"
#include "compare/write/quote.hpp"
#include "compare/write/write.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace springproof::compare {

using Json = nlohmann::ordered_json;

namespace {

std::string page_file(const std::string& name) {
  return read_file(cases::data_folder("report") + "/" + name);
}

/// A picture as an address, in two thirds of the length that base64 would have.
std::string address_of(const std::string& svg) {
  static const std::map<char, std::string> escapes{{'%', "%25"}, {'#', "%23"}, {'"', "%22"},
                                                   {'<', "%3C"}, {'>', "%3E"}, {'\n', " "}};
  std::string address = "data:image/svg+xml,";
  for (const char c : svg) {
    const auto escaped = escapes.find(c);
    address += escaped == escapes.end() ? std::string(1, c) : escaped->second;
  }
  return address;
}

} // namespace

std::string page_script(const std::string& name) {
  return read_file(cases::data_folder("scripts") + "/" + name);
}

std::string filled_page(const std::string& data, const std::map<std::string, std::string>& values) {
  const auto file = [&](const std::string& name) { return read_file(cases::data_folder(data) + "/" + name); };
  const std::string text = file("page.html");
  std::string result;
  std::size_t from = 0;
  for (std::size_t open = text.find("{{"); open != std::string::npos; open = text.find("{{", from)) {
    const std::size_t close = text.find("}}", open);
    const std::string name = text.substr(open + 2, close - open - 2);
    const auto value = values.find(name);
    result += text.substr(from, open - from) + (value == values.end() ? file(name) : value->second);
    from = close + 2;
  }
  return result + text.substr(from);
}

std::string embedded(const Json& document) {
  std::string result;
  for (const char c : document.dump(-1, ' ', true, Json::error_handler_t::replace))
    result += c == '<' ? "\\u003c" : std::string(1, c);
  return result;
}

std::string picture(const std::string& folder, const std::string& name, const std::string& caption) {
  return fmt::format("<figure id=\"picture-{}\"><img src=\"{}\" alt=\"{}\"></figure>\n", escape(name),
                     escape(address_of(read_file(folder + "/" + name + ".svg"))), escape(caption));
}

void write_page(const std::string& file, const std::string& title, Json data, const std::string& pictures) {
  data["provenance"] = provenance();
  data["licences"] = {page_file("three_licence.txt"), page_file("chart_licence.txt")};
  const std::string page = filled_page("report", {{"title", escape(title)},
                                                  {"pictures", pictures},
                                                  {"data", embedded(data)},
                                                  {"three", page_script("three.min.js")},
                                                  {"controls", page_script("OrbitControls.js")},
                                                  {"chart", page_script("chart.min.js")}});
  write_file(file, [&](std::ostream& out) { out << page; });
}

} // namespace springproof::compare
