#pragma once

#include "compare/error_bars/convergence.hpp"

#include <cmath>

/// Parts of an error at one measure, a number or a field.
namespace springproof::compare {

using Field =
    std::vector<Eigen::Vector3d>; ///< one vector per node; of a measure that is a number, (number, 0, 0)

/// a + factor (b - c)
inline Field moved(const Field& a, double factor, const Field& b, const Field& c) {
  Field result(a.size());
  for (std::size_t n = 0; n < a.size(); ++n) result[n] = a[n] + factor * (b[n] - c[n]);
  return result;
}

inline Field difference(const Field& a, const Field& b) {
  return moved(Field(a.size(), Eigen::Vector3d::Zero()), 1, a, b);
}

/// A value, such as another step or mesh would have it, and by how much it may be wrong.
struct Known {
  Field value, uncertainty;
};

/// What parts of an error at one measure are made of.
class MeasuredParts {
 public:
  MeasuredParts(const cases::Measure& measure, const cases::Scene& scene)
      : measure_(measure), scene_(scene), is_field_(is_field_norm(measure.kind)) {}

  /// What the measure is of a solution; nothing where it has no value.
  std::optional<Field> value(const cases::Scene& scene, const cases::Solution& solution) const {
    if (is_field_) {
      Field field = solution.displacement; // the nodes of the body's own mesh are the first
      field.resize(scene_.mesh.nodes.size());
      return field;
    }
    const auto number = value_of(*find_named(scene.definition.measures, measure_.name), scene, solution);
    if (!number || !std::isfinite(*number)) return std::nullopt;
    return Field{{*number, 0, 0}};
  }

  /// The limit of values on meshes from coarse to fine, or why there is none.
  std::variant<Known, std::string> limit(const std::vector<Field>& coarse_to_fine) const {
    if (is_field_) {
      std::vector<const Field*> fields;
      for (const Field& field : coarse_to_fine) fields.push_back(&field);
      auto found = find_limit(fields, [this](const Field& field) { return size(field); });
      if (auto* reason = std::get_if<std::string>(&found)) return *reason;
      auto& limit = std::get<FieldLimit>(found);
      return Known{std::move(limit.value), std::move(limit.uncertainty)};
    }
    std::vector<double> numbers;
    for (const Field& field : coarse_to_fine) numbers.push_back(field[0][0]);
    const auto found = find_limit(numbers);
    if (const auto* reason = std::get_if<std::string>(&found)) return *reason;
    return of_number(std::get<Limit>(found));
  }

  static Known of_number(const Limit& limit) {
    return {Field{{limit.value, 0, 0}}, Field{{limit.uncertainty, 0, 0}}};
  }

  double size(const Field& field) const {
    return is_field_ ? field_norm(measure_.kind, scene_.mesh, field) : std::abs(field[0][0]);
  }

  /// A difference in percent of the truth, with a number's sign; of a field its share in the whole
  /// difference, p.e/|e|, where 4 p.e = |p + e|² - |p - e|².
  double percent(const Field& part, const Field& whole, const Field& truth) const {
    if (!is_field_) return 100 * part[0][0] / truth[0][0];
    const double sum = size(moved(part, 1, whole, Field(whole.size(), Eigen::Vector3d::Zero()))),
                 rest = size(difference(part, whole)), all = size(whole);
    return all > 0 ? 100 * (sum * sum - rest * rest) / (4 * all * size(truth)) : 0;
  }

 private:
  const cases::Measure& measure_;
  const cases::Scene& scene_;
  bool is_field_;
};

/// What the step of a motion adds to a value: value - f0 with Richardson's f0 = f2 + (f2 - f1)/(2^p - 1).
inline Field step_part(const Field& value, const Field& half_step, int order) {
  const double factor = std::pow(2, order) / (std::pow(2, order) - 1);
  return moved(Field(value.size(), Eigen::Vector3d::Zero()), factor, value, half_step);
}

/// One model on one lattice, with the case's step and with half of it.
struct SolvedLattice {
  cases::Scene scene;
  cases::Solution solution;
  std::optional<cases::Solution> half_step{};
};

} // namespace springproof::compare
