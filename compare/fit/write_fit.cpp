#include "compare/fit/fit.hpp"
#include "compare/provenance/print.hpp"
#include "compare/table/table.hpp"
#include "compare/write/quote.hpp"

#include <fmt/format.h>
#include <ostream>

namespace springproof::compare {

namespace {

std::string status_of(const Fit& fit) {
  return !fit.found.undetermined.empty() ? "undetermined" : fit.found.failure.empty() ? "fitted" : "failed";
}

std::optional<double> at(const Eigen::VectorXd& values, std::size_t i) {
  return values.size() == 0 ? std::nullopt : std::optional(values[static_cast<Eigen::Index>(i)]);
}

/// A parameter's row. What the data leave open has no values.
Json parameter_rows(const Fit& fit) {
  Json rows = Json::array();
  const bool has = fit.found.has_values();
  for (std::size_t p = 0; p < fit.parameters.size(); ++p) {
    const auto value_of = [&](const Eigen::VectorXd& all) { return has ? at(all, p) : std::nullopt; };
    rows.push_back({{"parameter", fit.parameters[p].name},
                    {"start", fit.parameters[p].start},
                    {"value", value_of(fit.found.parameters)},
                    {"lower", value_of(fit.found.lower)},
                    {"upper", value_of(fit.found.upper)}});
  }
  return rows;
}

Json datum_to_json(const FittedDatum& row) {
  Json json{{"place", row.place}, {"measure", row.measure}, {"unit", row.unit}};
  json["line"] = row.line > 0 ? Json(row.line) : Json(nullptr);
  json["datum"] = row.value;
  json["fitted"] = row.fitted;
  json["difference"] = row.fitted ? Json(*row.fitted - row.value) : Json(nullptr);
  json["difference_percent"] =
      row.fitted && row.value != 0 ? Json(100 * (*row.fitted / row.value - 1)) : Json(nullptr);
  json["held_out"] = row.is_held_out;
  return json;
}

Json measure_to_json(const FittedMeasure& m) {
  return {
      {"measure", m.measure}, {"n", m.n}, {"error_percent", m.error_percent}, {"held_out", m.is_held_out}};
}

Json held_out_to_json(const HeldOut& held) {
  Json json{{"how", text_or_null(held.how)},
            {"reason", text_or_null(held.reason)},
            {"error_percent", held.error_percent},
            {"start_error_percent", held.start_error_percent}};
  json["factor"] = held.error_percent.value_or(0) > 0 && held.start_error_percent
                       ? Json(*held.start_error_percent / *held.error_percent)
                       : Json(nullptr);
  return json;
}

Json fit_to_json(const Fit& fit) {
  return {{"model", fit.model},
          {"data", fit.data},
          {"status", status_of(fit)},
          {"reason", text_or_null(fit.found.failure)},
          {"parameters", parameter_rows(fit)},
          {"undetermined", fit.found.undetermined},
          {"singular_values", fit.found.singular_values},
          {"n_data", fit.n_data},
          {"deviations", fit.has_deviations ? "given" : "from the residuals"},
          {"measures", json_list(fit.measures, measure_to_json)},
          {"rows", json_list(fit.rows, datum_to_json)},
          {"held_out", held_out_to_json(fit.held_out)},
          {"solves", fit.n_solves},
          {"noise", fit.found.noise},
          {"difference_step", fit.found.step},
          {"settings", fit.settings}};
}

void write_undetermined(std::ostream& out, const Fit& fit) {
  write_paragraph(out,
                  "The data do not determine these combinations of relative changes: along them the 95 % "
                  "interval is wider than the values themselves. No value is given.");
  for (const std::string& combination : fit.found.undetermined) print(out, "  {}\n", combination);
  write_paragraph(out, "Fit fewer parameters (--free, --terms), or add data that tell them apart: lateral "
                       "displacements and volumes tell poissons_ratio, forces tell moduli.");
}

void write_held_out(std::ostream& out, const HeldOut& held) {
  if (!held.reason.empty()) {
    write_paragraph(out, "nothing held out: " + held.reason, "", "  ");
    return;
  }
  if (!held.error_percent) {
    write_paragraph(
        out, fmt::format("held out ({}): all of these data are 0, which have no relative error", held.how),
        "", "  ");
    return;
  }
  std::string text = fmt::format("held out ({}): error {:.3g} %", held.how, *held.error_percent);
  if (held.start_error_percent && *held.error_percent > 0)
    text += fmt::format(", with the values of the start {:.3g} %: {:.3g} times as much",
                        *held.start_error_percent, *held.start_error_percent / *held.error_percent);
  write_paragraph(out, text, "", "  ");
}

} // namespace

Json fits_to_json(const std::vector<Fit>& fits) {
  return {{"schema", 1}, {"fits", json_list(fits, fit_to_json)}};
}

void write_fit_text(std::ostream& out, const Fit& fit, bool has_rows) {
  constexpr std::size_t most_rows = 40;
  print(out, "{}, fitted to {} data of {}: {}\n", fit.model, fit.n_data, fit.data, status_of(fit));
  if (!fit.found.undetermined.empty()) {
    write_undetermined(out, fit);
    return;
  }
  if (!fit.found.failure.empty()) {
    write_paragraph(out, fit.found.failure);
    return;
  }
  write_table(out, columns_of("parameter start{:.6g} value{:.6g} from=lower{:.6g} to=upper{:.6g}"),
              parameter_rows(fit));
  print(out, "from and to: 95 % intervals, by {}\n\n",
        fit.has_deviations ? "the data's standard deviations" : "the residuals");
  if (fit.found.noise)
    print(out, "noise of the answers: {:.2g} of their size; derivatives are differences of {:.2g} %\n\n",
          *fit.found.noise, 100 * fit.found.step);
  if (has_rows && fit.rows.size() <= most_rows && !fit.rows.empty())
    write_table(out,
                columns_of("place measure{:<} datum{:.6g} fitted{:.6g} difference_%=difference_percent{:.2f} "
                           "held~out=held_out"),
                json_list(fit.rows, datum_to_json));
  write_table(out, columns_of("measure n error~%=error_percent{:.3g} held~out=held_out"),
              json_list(fit.measures, measure_to_json));
  write_held_out(out, fit.held_out);
  if (fit.n_solves > 0) print(out, "{} solves\n", fit.n_solves);
  for (const std::string& setting : fit.settings) print(out, "{}\n", shell_line({"--set", setting}));
}

void write_fit_csv(std::ostream& out, const std::vector<Fit>& fits) {
  Json rows = Json::array();
  for (const Fit& fit : fits)
    for (const FittedDatum& datum : fit.rows) {
      Json row{{"model", fit.model}};
      row.update(datum_to_json(datum));
      rows.push_back(row);
    }
  write_csv(out, columns_of("model place measure unit line datum fitted difference held_out"), rows);
}

} // namespace springproof::compare
