#include "msm/design/uniaxial.hpp"

#include "cases/case/error.hpp"
#include "cases/case/input_file.hpp"
#include "mechanics/laws/ogden.hpp"
#include "mechanics/laws/principal_stress.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

namespace springproof::msm {

namespace {

std::vector<double> numbers_of(const cases::TextRow& row) {
  std::vector<double> numbers;
  for (const std::string_view field : row.fields) {
    const auto number = cases::number_in<double>(field);
    if (!number) throw cases::InputError(fmt::format("{}\"{}\" is no finite number", row.place(), field));
    numbers.push_back(*number);
  }
  return numbers;
}

/// @param place  for messages
double logarithmic(double strain, CurveStrain kind, const std::string& place) {
  constexpr double largest = 2;
  const double found = kind == CurveStrain::logarithmic   ? strain
                       : kind == CurveStrain::engineering ? std::log1p(strain)
                                                          : std::log(strain);
  if (std::abs(found) <= largest) return found;
  throw cases::InputError(fmt::format(
      "{}{:g} as {} is a logarithmic strain of {:.3g}, must be from -{} to {}; strains are no percent", place,
      strain, kind == CurveStrain::stretch ? "stretch" : cases::name_of(kind) + " strain", found, largest,
      largest));
}

/// Converts a row to what UniaxialCurve has: strain, stress, lateral strain.
std::array<double, 3> converted(const std::vector<double>& row, const CurveColumns& columns,
                                const std::string& place) {
  constexpr double megapascals[] = {1e-6, 1e-3, 1};
  const double strain = logarithmic(row[0], columns.strain, place);
  const double lateral = columns.poissons_ratio ? -*columns.poissons_ratio * strain
                         : row.size() == 3      ? logarithmic(row[2], columns.strain, place)
                                                : -0.5 * strain;
  const double stress = megapascals[static_cast<std::size_t>(columns.unit)] * row[1];
  return {strain, columns.stress == CurveStress::nominal ? stress * std::exp(-2 * lateral) : stress, lateral};
}

bool all_zero(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double value) { return value == 0; });
}

} // namespace

StressLaw ogden_law(const cases::Ogden& ogden) {
  return [parameters = mechanics::parameters_of(ogden)](double stretch) {
    const double strain = std::log(stretch);
    const auto stress =
        mechanics::kirchhoff_stress<mechanics::Ogden>(parameters, {strain, -strain / 2, -strain / 2});
    return stress[0] - stress[1]; // the pressure that frees the sides
  };
}

StressLaw yeoh_law(const std::vector<double>& coefficients) {
  return [coefficients](double stretch) {
    const double invariant = stretch * stretch + 2 / stretch - 3;
    double slope = 0;
    for (std::size_t i = 0; i < coefficients.size(); ++i)
      slope += static_cast<double>(i + 1) * coefficients[i] * std::pow(invariant, static_cast<double>(i));
    return 2 * (stretch * stretch - 1 / stretch) * slope;
  };
}

UniaxialCurve sample(const StressLaw& law, double poissons_ratio, const StrainRange& range) {
  if (!(range.highest > range.lowest) || range.n_values < 2)
    throw cases::InputError("strain range: needs at least two values and an upper end above the lower one");
  UniaxialCurve curve;
  for (int i = 0; i < range.n_values; ++i) {
    const double strain = range.lowest + (range.highest - range.lowest) * i / (range.n_values - 1);
    curve.axial_strain.push_back(strain);
    curve.stress.push_back(law(std::exp(strain)));
    curve.lateral_strain.push_back(-poissons_ratio * strain);
  }
  return curve;
}

UniaxialCurve read_curve(const std::string& text, const std::string& name, const CurveColumns& columns) {
  UniaxialCurve curve;
  const auto add = [&](const cases::TextRow& line) {
    const std::vector<double> row = numbers_of(line);
    if (row.size() != 2 && row.size() != 3)
      throw cases::InputError(fmt::format(
          "{}{} columns; a curve has strain, stress and perhaps lateral strain", line.place(), row.size()));
    const auto [strain, stress, lateral] = converted(row, columns, line.place());
    if (!curve.axial_strain.empty() && !(strain > curve.axial_strain.back()))
      throw cases::InputError(line.place() + "the strains must increase from line to line");
    curve.axial_strain.push_back(strain);
    curve.stress.push_back(stress);
    curve.lateral_strain.push_back(lateral);
  };
  cases::read_rows(
      text, name, cases::Between::commas_or_blanks, [](const cases::TextRow&) {}, add);
  if (curve.axial_strain.size() < 2)
    throw cases::InputError(fmt::format("{}: a curve needs at least two strains, this one has {}", name,
                                        curve.axial_strain.size()));
  if (all_zero(curve.stress)) throw cases::InputError(name + ": every stress is zero");
  if (all_zero(curve.lateral_strain)) throw cases::InputError(name + ": every lateral strain is zero");
  return curve;
}

} // namespace springproof::msm
